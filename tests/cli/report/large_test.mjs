// SPDX-License-Identifier: Apache-2.0
// node large_test.mjs DIRECTORY: limits of the page of five hours at 200 Hz. Of each time the smallest of several
// is taken: other work on the machine only adds to it.
import { readFileSync, statSync } from "node:fs";
import path from "node:path";
import { check, finish, ink, open, painted, rendererMegabytes, start } from "./browser.mjs";

const file = path.join(process.argv[2], "large.html");
const spikes = JSON.parse(readFileSync(path.join(process.argv[2], "large.spikes.json"), "utf8"));
const browser = await start();
const limit = (value, most, what, unit) => {
  console.log(`${what}: ${value.toFixed(1)} ${unit}, at most ${most}`);
  check(value <= most, `${what}: ${value} ${unit}`);
};

limit(statSync(file).size / 1e6, 2, "size", "MB");
let paint = Infinity, drawn = Infinity;
for (let i = 0; i < 5; ++i) {
  const { context, page } = await open(browser, file);
  await painted(page);
  paint = Math.min(paint, await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime));
  drawn = Math.min(drawn, await page.evaluate(() => performance.getEntriesByName("plots")[0].startTime));
  await context.close();
}
limit(paint, 1000, "first paint", "ms");
limit(drawn, 1000, "all plots drawn", "ms");

const { context, page, trouble } = await open(browser, file);
await painted(page);
for (let i = 0; i < 6; ++i) check((await ink(page, i)).columns > 0.95, `plot ${i} is not drawn from end to end`);
// From the release of the button to the frame with the plots in sight redrawn.
const times = [];
for (let i = 0; i < 12; ++i) {
  const box = await page.locator(".u-over").first().boundingBox();
  await page.evaluate(() => {
    window.zoomed = new Promise(done => document.addEventListener("mouseup", () => {
      const start = performance.now(), channel = new MessageChannel();
      channel.port1.onmessage = () => done(performance.now() - start);
      requestAnimationFrame(() => channel.port2.postMessage(0));
    }, { capture: true, once: true }));
  });
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.8 * box.width, box.y + 44, { steps: 5 });
  await page.mouse.up();
  const time = await page.evaluate(() => window.zoomed);
  // The plots out of sight follow.
  await page.waitForFunction(() => hemiPlots.every(p => p.u.scales.x.min === hemiPlots[0].u.scales.x.min), null, { timeout: 5000 });
  const [min, max] = await page.evaluate(() => [hemiPlots[5].u.scales.x.min, hemiPlots[5].u.scales.x.max]);
  // A zoom that did not happen counts as endless.
  times.push(Math.abs((max - min) / (18000 * 0.6 ** (i % 4 + 1)) - 1) < 0.05 ? time : Infinity);
  if (i % 4 === 3) await page.locator(".tools button").last().click();
  await page.evaluate(() => scrollTo(0, 0));
}
limit(Math.min(...times), 50, "zoom", "ms");
console.log(`  all zooms: ${times.map(t => t.toFixed(0)).join(" ")} ms`);
await page.locator(".tools button").last().click();
limit(Math.max(...await rendererMegabytes(browser)), 150, "memory of the tab", "MB");

for (const spike of spikes) {
  const found = await page.evaluate(s => {
    const series = hemiPlots[s.channel].spec.series[0];
    return series.x.some((x, i) => x === s.time_s && series.y[i] === s.value);
  }, spike);
  check(found, `the single sample ${spike.value} at ${spike.time_s} s is not in plot ${spike.channel}`);
}
check(trouble.length === 0, trouble.join("; "));
await context.close();
await browser.close();
finish();
