// SPDX-License-Identifier: Apache-2.0
// node figures.mjs PAGES IMAGES [DOCS]: what a person sees of each page on a desktop and on a phone, as report-NAME.png and
// report-NAME-phone.png in IMAGES. With DOCS: those pictures must stand there too, and none of a page that is no more.
import { existsSync, mkdirSync, readdirSync } from "node:fs";
import path from "node:path";
import { check, finish, htmlFiles, open, painted, start } from "./browser.mjs";

const [pages, images, docs] = process.argv.slice(2);
mkdirSync(images, { recursive: true });
const browser = await start();
const screens = [["", {}], ["-phone", { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true }]];
const taken = [];
for (const file of htmlFiles(pages))
  for (const [suffix, options] of screens) {
    const { context, page } = await open(browser, file, options);
    await painted(page);
    const picture = `report-${path.basename(file, ".html")}${suffix}.png`;
    await page.screenshot({ path: path.join(images, picture) });
    taken.push(picture);
    await context.close();
  }
await browser.close();
check(taken.length > 0, `${pages}: no page`);
if (docs) {
  for (const picture of taken) check(existsSync(path.join(docs, picture)), `${docs}/${picture} is missing: run scripts/figures`);
  for (const picture of readdirSync(docs))
    check(!/^report-.*\.png$/.test(picture) || taken.includes(picture), `${docs}/${picture}: there is no such page any more`);
}
finish();
