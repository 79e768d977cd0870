// A notebook's output in a headless Chromium, at two widths, light and dark: node notebook_page.mjs OUTPUT.html FOLDER
// Prints what is wrong with it, a line each; nothing if all is well. The pictures stay in FOLDER.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "../report/html/browser.mjs";

const [output, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });

// What JupyterLab's style sheets do to tables of an output, and the colours of its themes.
const page = (dark) => `<!DOCTYPE html><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<style>
body { margin: 0; padding: 12px; font: 13px/1.4 system-ui, sans-serif;
  background: ${dark ? "#111" : "#fff"}; color: ${dark ? "#e0e0e0" : "#212121"}; }
table { border: none; font-size: 12px; table-layout: fixed; margin-left: auto; margin-bottom: 1em; }
thead { border-bottom: 1px solid #888; vertical-align: bottom; }
td, th, tr { vertical-align: middle; padding: 0.5em; line-height: normal; white-space: normal; max-width: none;
  border: none; text-align: right; }
th { font-weight: bold; }
tbody tr:nth-child(odd) { background: ${dark ? "#111" : "#fff"}; }
tbody tr:nth-child(even) { background: ${dark ? "#212121" : "#f5f5f5"}; }
</style><body>${readFileSync(output, "utf8")}`;

// The contrast of each text with the nearest background behind it, as WCAG 2 defines it.
const contrasts = `
  const light = ([r, g, b]) => [r, g, b].map((c) => c / 255)
    .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const numbers = (colour) => colour.match(/[0-9.]+/g).map(Number);
  const behind = (element) => {
    for (let at = element; at; at = at.parentElement) {
      const colour = numbers(getComputedStyle(at).backgroundColor);
      if (colour.length === 3 || colour[3] === 1) return colour;
    }
    return [255, 255, 255];
  };
  const texts = [...document.querySelectorAll("body *")]
    .filter((e) => [...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()) && e.tagName !== "STYLE");
  return texts.map((e) => {
    const [a, b] = [numbers(getComputedStyle(e).color), behind(e)].map(light);
    return [e.textContent.trim().slice(0, 40), (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05)];
  });`;

for (const dark of [false, true]) {
  const file = join(folder, `page-${dark ? "dark" : "light"}.html`);
  writeFileSync(file, page(dark));
  for (const width of [1000, 400]) {
    const name = `notebook-${dark ? "dark" : "light"}-${width}`;
    const browser = await Browser.open({ width, height: 700, dark });
    try {
      await browser.goTo(pathToFileURL(file).href);
      const over = await browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth");
      if (over > 0) console.log(`${name}: the page is ${over} pixels too wide`);
      const found = await browser.run(contrasts);
      if (found.length < 3) console.log(`${name}: ${found.length} texts are shown`);
      // 4.5 is what WCAG 2.1 asks of text of this size (level AA).
      for (const [text, contrast] of found) {
        if (contrast < 4.5) console.log(`${name}: '${text}' has a contrast of ${contrast.toFixed(1)}`);
      }
      writeFileSync(join(folder, `${name}.png`), await browser.screenshot());
    } finally {
      await browser.close();
    }
  }
}
