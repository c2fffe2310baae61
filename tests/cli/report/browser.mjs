// SPDX-License-Identifier: Apache-2.0
// What the browser tests share: Chromium, a page with all that went wrong on it, pixels.
import { createRequire } from "node:module";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import path from "node:path";

export const skipped = 77; // exit code that CTest takes for "not run"
const executable = process.env.CHROMIUM ?? "/usr/bin/chromium";

/// Headless Chromium; ends the test as skipped where it or the library that drives it is not installed.
export async function start() {
  const require = createRequire(path.join(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), "../../../cli/report/package.json"));
  if (!existsSync(executable)) {
    console.log(`skipped: no ${executable}; scripts/setup installs it`);
    process.exit(skipped);
  }
  let playwright;
  try {
    playwright = require("playwright-core");
  } catch {
    console.log("skipped: no playwright-core; scripts/setup installs it");
    process.exit(skipped);
  }
  return playwright.chromium.launch({
    executablePath: executable,
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
      "--disable-component-update", "--disable-sync"],
  });
}

let failures = 0;
export function check(good, what) {
  if (good) return;
  failures += 1;
  console.log(`FAILED: ${what}`);
}
export const finish = () => {
  console.log(failures === 0 ? "passed" : `${failures} checks failed`);
  process.exit(failures === 0 ? 0 : 1);
};

/// A file opened in a fresh context. `trouble` collects console messages, exceptions and requests.
export async function open(browser, file, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  const url = pathToFileURL(file).href, trouble = [];
  page.on("console", message => trouble.push(`console ${message.type()}: ${message.text()}`));
  page.on("pageerror", error => trouble.push(`exception: ${error.message}`));
  page.on("request", request => { if (request.url() !== url && !request.url().startsWith("data:")) trouble.push(`request: ${request.url()}`); });
  await page.goto(url);
  return { context, page, trouble };
}

/// Pixels of a plot's canvas in the colour of one of its curves, and the share of the plotting area's columns that
/// hold one.
export const ink = (page, index, series = 0) => page.evaluate(([i, k]) => {
  const { u } = hemiPlots[i], { canvas } = u.ctx, { left, top, width, height } = u.bbox;
  const data = u.ctx.getImageData(left, top, width, height).data;
  const rgb = getComputedStyle(document.documentElement).getPropertyValue(`--s${k}`).trim().match(/[0-9a-f]{2}/gi).map(h => parseInt(h, 16));
  const columns = new Set();
  let count = 0;
  for (let p = 0; p < data.length; p += 4) {
    if (data[p + 3] < 128 || Math.abs(data[p] - rgb[0]) + Math.abs(data[p + 1] - rgb[1]) + Math.abs(data[p + 2] - rgb[2]) > 60) continue;
    count += 1;
    columns.add((p / 4) % width);
  }
  return { count, columns: columns.size / width, canvas: [canvas.width, canvas.height] };
}, [index, series]);

/// Resolves after the frame in which what was asked for is on the screen.
export const painted = page => page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));

/// Memory of the renderer processes [MB]: what would be free if they were not there (proportional share).
export async function rendererMegabytes(browser) {
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  return processInfo.filter(p => p.type === "renderer").map(p => {
    const text = readFileSync(`/proc/${p.id}/smaps_rollup`, "utf8");
    return Number(/^Pss:\s+(\d+) kB/m.exec(text)[1]) / 1024;
  });
}

export const htmlFiles = directory => readdirSync(directory).filter(name => name.endsWith(".html")).map(name => path.join(directory, name));
