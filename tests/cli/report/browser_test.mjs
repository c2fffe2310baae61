// SPDX-License-Identifier: Apache-2.0
// node browser_test.mjs DIRECTORY: the pages of hemi_write_pages, or of program_pages.py, in headless Chromium.
import { existsSync, readFileSync, statSync } from "node:fs";
import path from "node:path";
import { check, finish, htmlFiles, ink, open, painted, start } from "./browser.mjs";

const directory = process.argv[2];
const browser = await start();
const name = file => path.basename(file);
/// What a plot shows once its linked ones out of sight have followed.
async function range(page, i) {
  await page.waitForFunction(() => hemiPlots.every(p => !p.spec.link || p.u.scales.x.min === p.view[0] && p.u.scales.x.max === p.view[1]), null, { timeout: 5000 });
  return page.evaluate(k => [hemiPlots[k].u.scales.x.min, hemiPlots[k].u.scales.x.max], i);
}
const box = (page, i) => page.locator("figure.plot").nth(i).locator(".u-over").boundingBox();

async function opensInSilence(file) {
  const { context, page, trouble } = await open(browser, file);
  await painted(page);
  check(trouble.length === 0, `${name(file)}: ${trouble.join("; ")}`);
  const verdict = await page.locator("#verdict").boundingBox();
  check(verdict !== null && verdict.y >= 0 && verdict.y + verdict.height <= 800, `${name(file)}: verdict not in view at 1280x800`);
  check((await page.locator("#verdict").innerText()).trim().length > 20, `${name(file)}: no verdict`);
  const plots = await page.locator("figure.plot").count();
  // Engines that agree leave nothing to draw, and a small proof may state no probability.
  if (!/^(prove|compare)/.test(name(file))) check(plots > 0, `${name(file)}: no plot`);
  check(await page.evaluate(() => hemiPlots.length) === plots, `${name(file)}: plots without life`);
  for (let i = 0; i < plots; ++i) {
    // Where an effect changes nothing in a channel, the curve after lies on the one before, and hides it.
    const hidden = await page.evaluate(k => {
      const [a, b] = hemiPlots[k].spec.series;
      const close = 0.01 * Math.max(...a.y.map(Math.abs));
      return b !== undefined && a.y.length === b.y.length && a.y.every((v, j) => Math.abs(v - b.y[j]) <= close);
    }, i);
    const { count, columns } = await ink(page, i, hidden ? 1 : 0);
    // A marker with its interval is nine pixels wide; half of that counts.
    const points = await page.evaluate(k => hemiPlots[k].spec.series.reduce((n, series) => n + series.x.length, 0), i);
    check(count > 100 && columns > Math.min(0.03, 0.004 * points), `${name(file)}: plot ${i} is empty (${count} pixels, ${columns} of the columns)`);
    const titles = await page.evaluate(k => hemiPlots[k].u.axes.map(a => a.label), i);
    // Numbers beside the axes are those of the lines that they stand at.
    const wrong = await page.evaluate(k => hemiPlots[k].u.axes.flatMap(a => a._splits.map((v, j) => [v, a._values[j], a._splits[1] - a._splits[0]]))
      .filter(([v, label]) => label && /^[−0-9.]+$/.test(label)).filter(([v, label, step]) => Math.abs(Number(label.replace("−", "-")) - v) > 1e-3 * Math.min(step, Math.abs(v) || step)), i);
    check(wrong.length === 0, `${name(file)}: plot ${i} has wrong numbers at its axes: ${wrong}`);
    check(titles.length === 2 && titles.every(t => t.length > 1), `${name(file)}: plot ${i} has an axis without a title`);
  }
  check(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${name(file)}: wider than the page`);
  await context.close();
}

async function linkedZoom(file) {
  const { context, page, trouble } = await open(browser, file);
  const whole = await range(page, 0);
  const area = await box(page, 0);
  await page.mouse.move(area.x + area.width * 0.4, area.y + 40);
  await page.mouse.down();
  await page.mouse.move(area.x + area.width * 0.5, area.y + 50, { steps: 4 });
  await page.mouse.up();
  const near = (a, b, share) => Math.abs(a - b) < share * (whole[1] - whole[0]);
  const [from, to] = await range(page, 0);
  check(near(from, whole[0] + 0.4 * (whole[1] - whole[0]), 0.01) && near(to, whole[0] + 0.5 * (whole[1] - whole[0]), 0.01), `drag zooms to ${from}, ${to}`);
  for (let i = 1; i < 6; ++i) {
    const other = await range(page, i);
    check(other[0] === from && other[1] === to, `plot ${i} is not linked: ${other}`);
  }
  const command = await page.locator(".stretch code").innerText();
  const ends = /--from (\S+) --to (\S+) /.exec(command);
  check(ends && near(Number(ends[1]), from, 1e-4) && near(Number(ends[2]), to, 1e-4), `the command is ${command} at ${from}, ${to}`);
  await page.mouse.dblclick(area.x + area.width * 0.5, area.y + 40);
  check((await range(page, 3)).every((v, k) => v === whole[k]), "double-click does not show the whole");
  await page.locator(".live").first().focus();
  await page.keyboard.press("+");
  const keyed = await range(page, 5);
  check(near(keyed[1] - keyed[0], 0.5 * (whole[1] - whole[0]), 1e-6), `the plus key zooms to ${keyed}`);
  await page.keyboard.press("ArrowRight");
  check((await range(page, 5))[0] > keyed[0], "the arrow key does not move");
  await page.keyboard.press("0");
  check((await range(page, 5)).every((v, k) => v === whole[k]), "the key 0 does not show the whole");
  await page.locator(".tools button").first().focus();
  await page.keyboard.press("Enter");
  check((await range(page, 2))[1] < whole[1], "the zoom button does not work from the keyboard");
  check(trouble.length === 0, `zoom: ${trouble.join("; ")}`);
  await context.close();
}

/// Every extreme shows in the overview, and the pointer there reads its exact value.
async function extremes(file, spikes) {
  const { context, page } = await open(browser, file);
  for (const spike of spikes) {
    const place = await page.evaluate(s => {
      const u = hemiPlots[s.channel].u;
      hemiPlots[s.channel].figure.scrollIntoView({ block: "center" });
      return { x: u.valToPos(s.time_s, "x"), y: u.valToPos(s.value, "y") };
    }, spike);
    const area = await box(page, spike.channel);
    check(place.y > 0 && place.y < area.height, `spike of plot ${spike.channel} lies outside`);
    await page.mouse.move(area.x + place.x, area.y + 60);
    const tip = await page.locator("figure.plot").nth(spike.channel).locator(".tip").innerText();
    check(tip.includes(String(spike.value).replace("-", "−")), `plot ${spike.channel}: ${spike.value} is not in the tip: ${tip}`);
    check(tip.includes(String(spike.time_s)), `plot ${spike.channel}: its time ${spike.time_s} is not in the tip: ${tip}`);
    const drawn = await page.evaluate(({ s, at }) => {
      const { u } = hemiPlots[s.channel], px = devicePixelRatio;
      const rgb = getComputedStyle(document.documentElement).getPropertyValue("--s0").trim().match(/[0-9a-f]{2}/gi).map(h => parseInt(h, 16));
      const data = u.ctx.getImageData(u.bbox.left + at.x * px - 2, u.bbox.top + at.y * px - 2, 5, 5).data;
      let n = 0;
      for (let p = 0; p < data.length; p += 4) n += data[p + 3] > 60 && [0, 1, 2].every(c => Math.abs(data[p + c] - rgb[c]) < 40) ? 1 : 0;
      return n;
    }, { s: spike, at: place });
    check(drawn > 0, `plot ${spike.channel}: nothing is drawn at the spike`);
  }
  await context.close();
}

async function legend(file) {
  const { context, page } = await open(browser, file);
  const button = page.locator("figure.plot").first().locator(".legend button").first();
  const before = await ink(page, 0);
  await button.focus();
  await page.keyboard.press("Space");
  const off = await ink(page, 0);
  check(await button.getAttribute("aria-pressed") === "false" && off.count < 0.2 * before.count, `legend: ${before.count} pixels, switched off ${off.count}`);
  await button.click();
  const on = await ink(page, 0);
  check(await button.getAttribute("aria-pressed") === "true" && Math.abs(on.count - before.count) < 0.05 * before.count, "legend: the curve does not come back");
  await context.close();
}

async function withoutScript(file) {
  const { context, page, trouble } = await open(browser, file, { javaScriptEnabled: false });
  check(await page.locator("#verdict").isVisible(), `${name(file)}: no verdict without a script`);
  const figures = await page.locator("figure.plot").count();
  for (let i = 0; i < figures; ++i) {
    const svg = page.locator("figure.plot").nth(i).locator("svg.static");
    const area = await svg.boundingBox();
    check(area !== null && area.width > 400 && area.height > 100, `${name(file)}: no drawing ${i} without a script`);
    check(await svg.locator("path.line, path.mark").count() > 0, `${name(file)}: drawing ${i} is empty`);
  }
  check(await page.locator("#theme").isHidden(), `${name(file)}: a button that needs a script`);
  check(trouble.length === 0, `${name(file)} without a script: ${trouble.join("; ")}`);
  await context.close();
}

async function themes(file) {
  const { context, page } = await open(browser, file, { colorScheme: "dark" });
  const paper = () => page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
  const dark = await paper();
  await page.locator("#theme").click();
  const light = await paper();
  const brightness = colour => colour.match(/\d+/g).slice(0, 3).reduce((a, b) => a + Number(b), 0);
  check(brightness(dark) < 150 && brightness(light) > 650, `dark is ${dark}, light is ${light}`);
  await context.close();
}

async function phone(file) {
  const { context, page, trouble } = await open(browser, file, { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true });
  await painted(page);
  check(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${name(file)}: wider than a phone`);
  const verdict = await page.locator("#verdict").boundingBox();
  check(verdict.y + verdict.height <= 844, `${name(file)}: verdict not in view on a phone`);
  for (const area of await page.locator("figure.plot .u-over").all())
    check((await area.boundingBox()).width > 240, `${name(file)}: a narrow plot on a phone`);
  check(trouble.length === 0, `${name(file)} on a phone: ${trouble.join("; ")}`);
  await context.close();
}

/// A4: the drawings of the page without a script stand there, the buttons do not.
async function paper(file) {
  const { context, page } = await open(browser, file);
  await page.emulateMedia({ media: "print" });
  check(await page.locator("figure.plot svg.static").first().isVisible(), `${name(file)}: no drawing in print`);
  for (const hidden of [".live", ".tools", "#theme"])
    check(await page.locator(hidden).first().isHidden(), `${name(file)}: ${hidden} in print`);
  const pdf = await page.pdf({ preferCSSPageSize: true });
  const media = /\/MediaBox\s*\[\s*0 0 ([\d.]+) ([\d.]+)/.exec(pdf.toString("latin1"));
  check(media && Math.abs(media[1] - 595) < 1.5 && Math.abs(media[2] - 842) < 1.5, `${name(file)}: prints on ${media?.[0]}`);
  await context.close();
}

for (const file of htmlFiles(directory)) {
  await opensInSilence(file);
  await withoutScript(file);
  await phone(file);
  check(statSync(file).size <= 2e6, `${name(file)}: ${statSync(file).size} bytes`);
}
const at = file => path.join(directory, file);
if (existsSync(at("telemetry.html"))) {
  await linkedZoom(at("telemetry.html"));
  await extremes(at("telemetry.html"), JSON.parse(readFileSync(at("telemetry.spikes.json"), "utf8")));
  await legend(at("diagnosis.html"));
  await themes(at("mixed.html"));
  await paper(at("diagnosis.html"));
}
await browser.close();
finish();
