// The report of all examples of plug-ins in a headless Chromium: node examples_page_test.mjs REPORT.html RESULTS.json
// SHOTS-FOLDER. The exit code is 0 if all checks passed; screenshots stay in the folder.
import { Browser } from "../../cases/report/html/browser.mjs";
import { check, equal, expect, loaded, open, quiet, results, shoot, summed } from "../../cases/report/html/report_page.mjs";

const singles = ["jolt", "physx", "rapier"],
  doubles = ["mujoco-js", "toy-c", "toy-js", "toy-py"];
const browser = await Browser.open();

await check("each example has a column with numbers in it", async () => {
  for (const name of [...singles, ...doubles]) {
    const cells = results.cases.flatMap((one) => results.cells.filter((c) => c.case === one.id && c.engine === name));
    expect(cells.some((c) => c.status === "pass"), `${name} ran nowhere`);
    expect(cells.every((c) => ["pass", "unsupported"].includes(c.status)), `${name}: ${cells.map((c) => c.status)}`);
  }
});

await check("those in single precision are marked, and only those", async () => {
  await open(browser);
  const marked = await browser.run(
    "return [...document.querySelectorAll('th.engine')].filter(h => h.querySelector('.precision')).map(h => h.querySelector('.who').textContent)",
  );
  equal(marked.sort().join(" "), singles.join(" "), "marked as single precision");
  await shoot(browser, "overview", true);
});

await check("no two engines have the same colour", async () => {
  const hues = await browser.run(
    "return [...document.querySelectorAll('th.engine .stripe')].map(s => getComputedStyle(s).backgroundColor)",
  );
  equal(hues.length, results.engines.length, "columns");
  equal(new Set(hues).size, hues.length, "colours");
});

await check("a case's table marks them too, and the page has nothing to complain of", async () => {
  await open(browser, "#/springs/fixed-spring?dt=1/30");
  await loaded(browser, "springs/fixed-spring");
  const marked = await browser.run("return document.querySelectorAll('#numbers .precision').length");
  equal(marked, singles.length, "rows marked");
  await shoot(browser, "fixed-spring", true);
  await quiet(browser);
});

await browser.close();
process.exit(summed());
