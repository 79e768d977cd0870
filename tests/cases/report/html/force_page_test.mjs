// Contact forces in the report: arrows in the picture, a flag that hides them, and a plot for a pair of bodies.
// node force_page_test.mjs REPORT.html RESULTS.json SHOTS-FOLDER
import { setTimeout as sleep } from "node:timers/promises";
import { Browser } from "./browser.mjs";
import { check, equal, expect, loaded, open, quiet, ready, results, shoot, summed } from "./report_page.mjs";

const id = "forces-of-contact/box-at-rest",
  weight = 98.1; // N

const browser = await Browser.open();
const pressed = () => browser.run("return document.querySelector('[data-flag=forces]')?.getAttribute('aria-pressed') ?? null");
// The numbers beside a plot, in N.
const told = () =>
  browser.run(`return [...document.querySelectorAll('[data-plot=contact_force] .readouts > span')].map((s) => s.textContent)`);

try {
  await check("the force of a pair is plotted, and at rest it is the weight", async () => {
    await open(browser, `#/${id}?dt=1/240&engines=ode~bullet&t=1.5`);
    await loaded(browser, id);
    await sleep(300);
    equal(await pressed(), "true", "the flag of the forces");
    const values = await told();
    equal(values.length, 2, "readouts");
    for (const value of values) expect(Math.abs(parseFloat(value) - weight) < 1, `the plot tells ${value}`);
    await shoot(browser, "forces");
  });
  await check("e takes the forces away and brings them back", async () => {
    await browser.keys("e");
    equal(await pressed(), "false", "the flag of the forces");
    await browser.keys("e");
    equal(await pressed(), "true", "the flag of the forces");
    await quiet(browser);
  });
  await check("the first screen says whose contact forces explain the motion", async () => {
    await open(browser, "");
    await ready(browser);
    const shown = await browser.run(`return [...document.querySelectorAll('.trust tr[data-engine]')].map((row) =>
      [row.dataset.engine, row.querySelector('td').textContent])`);
    equal(shown.map(([name]) => name).sort().join(), "bullet,ode", "engines");
    for (const [name, text] of shown) {
      const found = results.cells.filter((c) => c.case === id && c.engine === name).map((c) => c.metrics.contact_balance.value / weight);
      const worst = Math.max(...found),
        [sign, share] = [text[0], text.slice(2)];
      equal(sign, worst <= 1e-6 ? "✓" : worst <= 1e-3 ? "≈" : "✕", `the sign of ${name}`);
      const told = Number(share.replace(" %", "").replace(/·10(.*)/, (_, power) => "e" + [...power].map((c) => (c === "⁻" ? "-" : "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(c))).join("")).replace("≈ 0", "0"));
      expect(Math.abs(told - 100 * worst) <= 0.06 * 100 * worst + 1e-9, `${name}: ${share} is not ${100 * worst} %`);
    }
    await shoot(browser, "trust");
  });
  await check("a case without reported forces has neither the flag nor the plot", async () => {
    await open(browser, "#/springs/fixed-spring?dt=1/30");
    await loaded(browser, "springs/fixed-spring");
    equal(await pressed(), null, "the flag of the forces");
    equal((await told()).length, 0, "readouts");
  });
} finally {
  await browser.close();
}
process.exit(summed());
