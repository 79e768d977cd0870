// A report's first screen as a picture: node first_screen.mjs REPORT.html PICTURE.png WIDTH HEIGHT
import { writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const [report, picture, width, height] = process.argv.slice(2);
const browser = await Browser.open({ width: Number(width), height: Number(height) });
try {
  await browser.goTo(pathToFileURL(report).href);
  await browser.until("document.documentElement.dataset.ready === 'true'", "the page to be ready");
  writeFileSync(picture, await browser.screenshot());
} finally {
  await browser.close();
}
