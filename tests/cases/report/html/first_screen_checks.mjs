// The first screen: the matrix, the findings, and what can be asked of it.
import { check, equal, expect, open, quiet, results, spring } from "./report_page.mjs";

export async function firstScreen(browser) {
  await check("the page is ready within 2 s of being opened", async () => {
    let quickest = Infinity; // of a few: what else the machine does only ever adds
    for (let i = 0; i < 4 && quickest >= 2000; ++i) {
      const began = Date.now();
      await open(browser);
      quickest = Math.min(quickest, Date.now() - began);
    }
    console.log(`      ready after ${quickest} ms`);
    expect(quickest < 2000, `it took ${quickest} ms`);
  });
  await check("of many runs the matrix shows one an engine, until it is opened", async () => {
    const columns = () => browser.run("return [...document.querySelectorAll('.matrix thead .engine')].map(t => t.title.split(/[: ]/)[0])");
    const runs = [...new Set(results.cells.map((c) => c.engine))];
    const before = await columns();
    if (runs.length <= 7) return equal(before.length, runs.length, "columns of few runs");
    const engines = new Set(runs.map((name) => name.split(/[:@,]/)[0]));
    equal(before.length, engines.size, "columns before anything is opened");
    await browser.run("let b; while ((b = document.querySelector('.open-engine[aria-expanded=false]'))) b.click()");
    equal((await columns()).length, runs.length, "columns once all are open");
  });
  await check("the matrix has a row a case and says of each cell what results.json says", async () => {
    equal(
      await browser.run("return document.querySelectorAll('.matrix th.case').length"),
      results.cases.length,
      "rows",
    );
    const cells = await browser.run(
      "return [...document.querySelectorAll('.matrix td.cell a')].map(a => [a.title, a.querySelector('.value').textContent, a.querySelector('.word').textContent])",
    );
    const shown = results.cells.filter((c) => c.dt === results.headline_dt);
    equal(cells.length, shown.length, "cells at the headline step");
    for (const cell of shown) {
      const [, value, word] = cells.find(([title]) => title.startsWith(`${cell.case}, ${cell.engine}, `)) ?? [];
      expect(word, `${cell.case} on ${cell.engine} is missing`);
      const expected = { diverged: "blown up", unsupported: "unsupported", pass: cell.verdict?.word }[cell.status];
      if (expected)
        expect(word.includes(expected), `${cell.case} on ${cell.engine}: "${word}" where ${expected} was expected`);
      if (cell.status === "pass") expect(/[0-9]/.test(value), `${cell.case} on ${cell.engine} has no number`);
    }
  });
  await check("the number in a cell is the one of results.json", async () => {
    const cell = results.cells.find((c) => c.case === spring && c.engine === "ode" && c.dt === "1/30");
    const text = await browser.run(
      "return [...document.querySelectorAll('.matrix td.cell a')].find(a => a.title.startsWith(arguments[0] + ', ode,')).querySelector('.value').textContent",
      spring,
    );
    equal(text, `${Number((1000 * cell.metrics.position_error.value).toPrecision(3))} mm`, "position error");
  });
  await check("findings are the sentences of results.json", async () => {
    const texts = await browser.run(
      "return [...document.querySelectorAll('.intro .answer')].map(a => [a.querySelector('h2').textContent, a.querySelector('.text').textContent, a.querySelector('.more')?.textContent ?? ''])",
    );
    equal(JSON.stringify(texts), JSON.stringify(results.findings.map((f) => [f.topic, f.text, f.more])), "sentences");
    expect(texts.length > 0, "there are none");
    const longest = Math.max(...texts.map(([, text]) => text.length));
    expect(longest < 700, `one is ${longest} characters long before it is asked for more`);
  });
  await check("the matrix's row of steps for 1 mm says what the finding says", async () => {
    const { text } = results.findings.find(({ topic }) => topic === "step size");
    const said = [...text.matchAll(/(ode|bullet) ~?([0-9.e-]+) ms/g)].map(([, who, ms]) => [who, Number(ms) / 1000]);
    expect(said.length > 0, `no step in "${text}"`);
    const [names, steps] = await browser.run(
      "return [[...document.querySelectorAll('.matrix thead .engine')].map(t => t.title.split(':')[0]), [...document.querySelectorAll('.summaries tr')].at(-1).querySelectorAll('td')].map((list) => [...list].map((x) => x.textContent ?? x))",
    );
    for (const [who, seconds] of said) {
      const [value, unit] = steps[names.indexOf(who)].split(" ");
      const shown = Number(value) * { s: 1, ms: 1e-3, µs: 1e-6 }[unit];
      expect(Math.abs(shown / seconds - 1) < 0.06, `${who}: ${steps[names.indexOf(who)]}, and ${seconds} s in words`);
    }
  });
  await check("the matrix shows the step that a tolerance needs, and the address says so", async () => {
    await browser.run(
      "const s = document.querySelectorAll('.controls select')[1]; s.value = 'step'; s.dispatchEvent(new Event('change'))",
    );
    await browser.until("location.hash.includes('show=step')");
    const text = await browser.run(
      "return [...document.querySelectorAll('.matrix td.cell a')].find(a => a.title.startsWith(arguments[0] + ', core:rk4,')).querySelector('.value').textContent",
      spring,
    );
    expect(/ m?s$/.test(text), `found "${text}"`);
    await browser.run(
      "const s = document.querySelectorAll('.controls select')[1]; s.value = 'main'; s.dispatchEvent(new Event('change'))",
    );
  });
  await check("arrow keys go from cell to cell, and enter opens one", async () => {
    await browser.run("document.querySelector('.matrix th.case a').focus()");
    await browser.keys("\uE014", "\uE015", "\uE012");
    const title = await browser.run(
      "return document.activeElement.closest('th.case') ? 'case' : document.activeElement.title",
    );
    equal(title, "case", "focus after right, down, left");
    await browser.keys("\uE007");
    await browser.until("location.hash.length > 3 && document.querySelector('.stage canvas')", "a case to open");
  });
  await check("nothing was complained of on the first screen", () => quiet(browser));
}
