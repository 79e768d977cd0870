// The tests of the laboratory's page share one headless Chromium, and use its controls as a person does. Words:
// PAGE.html SHOTS-FOLDER FOLDER-OF-node_modules.
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "../report/html/browser.mjs";
import { expect, quiet as quietIn, summed } from "../report/html/checks.mjs";

export { check, expect } from "../report/html/checks.mjs";

export const [page, shots, modules] = process.argv.slice(2);
const files = mkdtempSync(join(tmpdir(), "rigor-laboratory-"));
mkdirSync(shots, { recursive: true });

export const matches = (text, pattern, what) => expect(pattern.test(text), `${what}: found "${text}", expected ${pattern}`);

export const browser = await Browser.open({ width: 1400, height: 1000 });
export const run = (script, ...args) => browser.run(script, ...args);
export const text = (selector) => run("return document.querySelector(arguments[0])?.textContent ?? ''", selector);
export const click = (selector) => run("document.querySelector(arguments[0]).click()", selector);
export const hash = () => run("return decodeURIComponent(location.hash)");
export const step = () => run("return Number(document.querySelector('main').dataset.step)");
export const until = (script, what, seconds) => browser.until(script, what, seconds);
export const atStep = (n) => until(`document.querySelector('main').dataset.step === '${n}'`, `step ${n}`);
export const inAddress = (part) =>
  until(`decodeURIComponent(location.hash).includes(${JSON.stringify(part)})`, `${part} in the address`);
export const pick = (selector, value) =>
  run(
    "const s = document.querySelector(arguments[0]); s.value = arguments[1]; s.dispatchEvent(new Event('change', { bubbles: true }))",
    selector,
    value,
  );
export const slide = (selector, value) =>
  run(
    "const s = document.querySelector(arguments[0]); s.value = arguments[1]; s.dispatchEvent(new Event('input', { bubbles: true }))",
    selector,
    String(value),
  );
export const shoot = async (name, whole = false) =>
  writeFileSync(join(shots, `${name}.png`), await browser.screenshot({ whole }));
export async function open(fragment = "", at = page) {
  await browser.goTo("about:blank");
  await browser.goTo(pathToFileURL(resolve(at)).href + fragment);
  await until("document.documentElement.dataset.ready", "the laboratory to start");
}
export const quiet = () => quietIn(browser);
// Puts files into the page's own input, as a person's choice does: { name: content }.
export async function choose(contents) {
  const paths = Object.entries(contents).map(([name, content]) => {
    const path = join(files, name);
    writeFileSync(path, content);
    return path;
  });
  const found = await browser.post("/element", { using: "css selector", value: "#file" });
  await browser.post(`/element/${Object.values(found)[0]}/value`, { text: paths.join("\n") });
}
// Runs all checks, closes the browser, and ends with 0 if all passed.
export async function finish(checks) {
  try {
    await checks();
  } finally {
    await browser.close();
    rmSync(files, { recursive: true, force: true });
  }
  process.exit(summed());
}
