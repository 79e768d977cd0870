// Shared code of the page tests: the report from the command line, functions to open and read it, and counted checks.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { expect } from "./checks.mjs";

export { check, expect, quiet, summed } from "./checks.mjs";

export const [report, resultsFile, shots] = process.argv.slice(2);
export const url = pathToFileURL(report).href;
export const results = JSON.parse(readFileSync(resultsFile, "utf8"));
mkdirSync(shots, { recursive: true });

export const equal = (found, wanted, what) =>
  expect(found === wanted, `${what}: found ${JSON.stringify(found)}, expected ${JSON.stringify(wanted)}`);

export const shoot = async (browser, name, whole = false) =>
  writeFileSync(join(shots, `${name}.png`), await browser.screenshot({ whole }));
export const ready = (browser) =>
  browser.until("document.documentElement.dataset.ready === 'true'", "the page to be ready");
export const loaded = (browser, id) =>
  browser.until(
    `document.querySelector('.view').dataset.loaded?.startsWith(${JSON.stringify(id)})`,
    `${id} to be loaded`,
  );
// Fresh, even where only what stands behind the "#" differs.
export async function open(browser, hash = "") {
  await browser.goTo("about:blank");
  await browser.goTo(url + hash);
  await ready(browser);
}
export const clock = (browser) => browser.run("return parseFloat(document.querySelector('.clock').textContent)");
export const hash = (browser) => browser.run("return location.hash");
export const boxOf = (browser, selector) =>
  browser.run(
    "const r = document.querySelector(arguments[0]).getBoundingClientRect(); return {x: r.x, y: r.y, width: r.width, height: r.height}",
    selector,
  );
// How many different colours a canvas of the page shows.
export const colours = (browser, selector) =>
  browser.run(
    `
  const from = document.querySelector(arguments[0]), copy = document.createElement("canvas");
  copy.width = 160, copy.height = 100;
  const pen = copy.getContext("2d");
  pen.drawImage(from, 0, 0, 160, 100);
  return new Set(new Uint32Array(pen.getImageData(0, 0, 160, 100).data.buffer)).size`,
    selector,
  );

export const spring = "springs/fixed-spring";
