// The pages of a site in a headless Chromium: node site_page_test.mjs SITE-FOLDER CASE-ADDRESS SHOTS-FOLDER. Each is
// looked at in light and dark, at 1400 and 400 pixels, from files and from a server.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { pathToFileURL } from "node:url";
import { setTimeout as sleep } from "node:timers/promises";
import { Browser } from "../html/browser.mjs";
import { check, expect, summed } from "../html/checks.mjs";

const [site, caseName, shots] = process.argv.slice(2);
const modules = process.env.RIGOR_PAGE_MODULES;
mkdirSync(shots, { recursive: true });
const types = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".json": "application/json", ".svg": "image/svg+xml" };
const server = createServer((asked, answer) => {
  try {
    const text = readFileSync(join(site, new URL(asked.url, "http://x").pathname));
    answer.writeHead(200, { "content-type": types[extname(new URL(asked.url, "http://x").pathname)] ?? "text/plain" }).end(text);
  } catch {
    answer.writeHead(404).end();
  }
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
const served = `http://127.0.0.1:${server.address().port}/`,
  local = pathToFileURL(join(site, "/")).href;

const quiet = async (browser) => {
  const complaints = (await browser.complaints()).filter((text) => !text.includes("GPU stall") && !text.includes("favicon"));
  expect(!complaints.length, complaints.join("\n"));
};

const pages = { index: "index.html", engine: "engines/ode.html", metric: "metrics/position_error.html", case: `cases/${caseName}.html` };
const loaded = (browser) => browser.until("document.querySelector('.view')?.dataset.loaded", "the case to be loaded");

for (const [look, options] of Object.entries({
  light: { width: 1400, height: 900 },
  dark: { width: 1400, height: 900, dark: true },
  "phone-light": { width: 400, height: 800, touch: true },
  "phone-dark": { width: 400, height: 800, touch: true, dark: true },
})) {
  const browser = await Browser.open(options);
  for (const [name, address] of Object.entries(pages)) {
    await check(`${name}, ${look}: nothing is too wide, and axe-core finds nothing`, async () => {
      await browser.goTo(served + address);
      if (name === "case") await loaded(browser);
      await sleep(200);
      writeFileSync(join(shots, `${name}-${look}.png`), await browser.screenshot({ whole: true }));
      const over = await browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth");
      expect(over <= 0, `the page is ${over} pixels too wide`);
      const paper = await browser.run("return getComputedStyle(document.documentElement).backgroundColor");
      const [red] = paper.match(/\d+/).map(Number);
      expect(options.dark ? red < 80 : red > 200, `the background is ${paper}`);
      await quiet(browser);
      await browser.run(readFileSync(join(modules, "axe-core/axe.min.js"), "utf8") + "; window.axe = axe;");
      const found = await browser.callLater("axe.run(document, {resultTypes: ['violations']})");
      expect(!found.violations.length, found.violations.map((v) => `${v.id}: ${v.help}: ${v.nodes[0]?.html?.slice(0, 160)}`).join("\n"));
    });
  }
  await browser.close();
}

const browser = await Browser.open();
await check("a case works from a file, leads back, and runs no foreign script", async () => {
  await browser.goTo(local + pages.case);
  await loaded(browser);
  await quiet(browser);
  expect(await browser.run("return document.querySelectorAll('.stage canvas').length === 1"), "there is no picture");
  await browser.run("const s = document.createElement('script'); s.textContent = 'window.harm = 1'; document.body.append(s)");
  expect(await browser.run("return window.harm === undefined"), "a script in the page ran");
  await browser.complaints(); // tells of the refused script
  await browser.keys("\uE00C"); // Escape
  await browser.until("location.href.endsWith('index.html')", "the front page");
  await browser.goTo(served + pages.case + "#/" + "?t=0.5");
  await loaded(browser);
  expect(Math.abs((await browser.run("return parseFloat(document.querySelector('.clock').textContent)")) - 0.5) < 0.01, "the address does not hold the time");
});
await check("the matrix and the badge are on the front page", async () => {
  await browser.goTo(served + pages.index);
  await browser.until("[...document.images].every((image) => image.complete)", "badges");
  expect(await browser.run("return [...document.images].every((image) => image.naturalWidth > 60)"), "a badge is not drawn");
  expect(await browser.run("return document.querySelectorAll('.matrix tbody tr').length > 1"), "the matrix has no rows");
});
await browser.close();
server.close();
process.exit(summed());
