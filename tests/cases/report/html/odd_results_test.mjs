// Whether a report of few, failed, many or old results opens, and says what there is:
//   node odd_results_test.mjs REPORT.html RESULTS.json SHOTS-FOLDER
// The first case of the page is opened too. Screenshots stay in the folder.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const [report, resultsFile, shots] = process.argv.slice(2);
const results = JSON.parse(readFileSync(resultsFile, "utf8"));
mkdirSync(shots, { recursive: true });
const browser = await Browser.open({ width: 1400, height: 900 });
const expect = (condition, message) => {
  if (!condition) throw new Error(message);
};

try {
  const began = Date.now();
  await browser.goTo(pathToFileURL(report).href);
  await browser.until("document.documentElement.dataset.ready === 'true'", "the page to be ready", 60);
  console.log(`ready after ${Date.now() - began} ms`);
  writeFileSync(join(shots, "first.png"), await browser.screenshot());
  const title = await browser.run("return document.querySelector('.answer-first h1').textContent");
  expect(title.length > 10 && !/undefined|NaN|null/.test(title), `the answer is "${title}"`);
  const isStill = results.cases.length > 0 && results.cases.every(({ truth }) => truth.still);
  expect(title.startsWith("Nothing moves in") === isStill, `the answer is "${title}"`);
  const rows = await browser.run("return document.querySelectorAll('.matrix th.case').length");
  expect(rows === results.cases.length, `${rows} of ${results.cases.length} cases are in the matrix`);
  const text = await browser.run("return document.body.innerText");
  expect(!/undefined|NaN/.test(text), `the page says: ${/.{0,60}(undefined|NaN).{0,60}/.exec(text)?.[0]}`);
  const [one] = results.cases;
  await browser.run("location.hash = '#/' + encodeURIComponent(arguments[0])", one.id);
  await browser.until(`document.querySelector('.view').dataset.loaded?.startsWith(${JSON.stringify(one.id)})`, "the first case", 60);
  expect(await browser.run("return document.querySelector('.scene-sketch').childElementCount > 0"), "the sketch is empty");
  const bare = await browser.run("return [...document.querySelectorAll('.scene-sketch .solid')].filter((e) => !e.childElementCount).length");
  expect(bare === 0, `the sketch leaves out ${bare} shapes`);
  const balls = await browser.run("return [...document.querySelectorAll('.scene-sketch .solid circle')].map((c) => c.getAttribute('cx') + ' ' + c.getAttribute('cy'))");
  expect(new Set(balls).size === balls.length, "the sketch has two balls in one place");
  const shown = await browser.run("return document.querySelector('.view').innerText");
  expect(!/undefined|NaN/.test(shown), `the case says: ${/.{0,60}(undefined|NaN).{0,60}/.exec(shown)?.[0]}`);
  const answer = await browser.run("return document.querySelector('.view .answer-first h1').textContent");
  expect(answer.startsWith("Nothing moves in this case") === (one.truth.still ?? false), `the case's answer is "${answer}"`);
  writeFileSync(join(shots, "case.png"), await browser.screenshot());
  const complaints = (await browser.complaints()).filter((line) => !line.includes("GPU stall due to ReadPixels"));
  expect(!complaints.length, complaints.join("\n"));
} finally {
  await browser.close();
}
