// The first screen: its answer and picture, the problems found, and the matrix.
import { boxOf, check, equal, expect, open, quiet, results, spring } from "./report_page.mjs";

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
    equal(text, `${Number((1000 * cell.metrics.position_error.value).toPrecision(2))} mm`, "position error");
  });
  await check("problems are the sentences of results.json", async () => {
    const texts = await browser.run(
      "return [...document.querySelectorAll('.problems .answer')].map(a => [a.querySelector('h3').textContent, a.querySelector('.text').textContent, a.querySelector('.more')?.textContent ?? ''])",
    );
    equal(JSON.stringify(texts.map(([, ...rest]) => rest)), JSON.stringify(results.findings.filter((f) => f.topic !== "recommendation").map((f) => [f.text, f.more])), "sentences");
    for (const [headline] of texts) expect(headline.split(" ").length <= 10, `a long headline: "${headline}"`);
    expect(texts.length > 0, "there are none");
    const open = await browser.run(
      "return [...document.querySelectorAll('.problems .answer')].filter(a => !a.closest('.more-problems:not([open])')).length",
    );
    expect(open <= 6, `${open} are shown at first`);
  });
  await check("the answer is the recommendation of results.json", async () => {
    const { external, core, reference } = results.recommendation;
    const [title, beside] = await browser.run(
      "return [...document.querySelectorAll('.answer-first h1, .answer-first .beside')].map(e => e.textContent)",
    );
    if (external) {
      expect(title.includes(external.engine) && title.includes(`${external.dt} s`), `found "${title}"`);
      const { failed, cases } = external,
        outcome = failed ? `${failed} failed` : "none failed";
      expect(beside.includes(`${cases} of ${results.cases.length} cases were compared with their true motion`), `"${beside}"`);
      const lacking = new Set(results.cells.filter((c) => c.engine === external.engine && c.status === "unsupported").map((c) => c.case)).size;
      equal(external.unsupported, lacking, "cases that it cannot run");
      equal(/It cannot run (\d+)\./.exec(beside)?.[1] ?? "0", String(lacking), "cases that it cannot run, as said");
      expect(beside.includes(outcome), `failures are not said: "${beside}"`);
    } else expect(title.startsWith("No engine stays within"), `found "${title}"`);
    for (const choice of [core, reference])
      if (choice) expect(beside.includes(`${choice.engine} at ${choice.dt} s`), `"${beside}" lacks ${choice.engine}`);
  });
  await check("each main engine has a curve and a card, and a run that fails is never called the cheapest", async () => {
    const cards = await browser.run("return [...document.querySelectorAll('.card')].map(c => c.innerText)");
    const names = await browser.run("return [...document.querySelectorAll('.curve-name')].map(t => t.textContent)");
    const external = new Set(results.engines.filter((e) => !e.name.startsWith("core")).map((e) => e.name.split(/[:@,]/)[0]));
    for (const name of external) {
      expect(names.some((n) => n.startsWith(name)), `${name} has no curve`);
      expect(cards.some((c) => c.startsWith(name)), `${name} has no card`);
    }
    for (const card of cards.filter((c) => c.includes("recommended"))) expect(!card.includes("no step within"), card);
  });
  await check("each card counts the stable runs at its largest usable step, as results.json does", async () => {
    const cards = await browser.run("return [...document.querySelectorAll('.card')].map(c => [c.querySelector('h2').firstChild.textContent, c.innerText])");
    for (const [engine, text] of cards) {
      const [, stable, of, dt] = /stable in (\d+) of the (\d+) cases? that it runs at (\S+) s/.exec(text) ?? [];
      expect(dt, `no count: "${text}"`);
      const ran = results.cells.filter((c) => c.engine === engine && c.dt === dt && c.status !== "unsupported");
      equal(Number(of), ran.length, `${engine}: runs`);
      const good = ran.filter((c) => c.status === "pass" && c.verdict.word === "stable" && !c.reduced_order);
      equal(Number(stable), good.length, `${engine}: stable runs`);
      const usable = / up to (\S+) s/.exec(text)?.[1];
      if (usable) equal(dt, usable, `${engine}: the step`);
    }
    const meaning = await browser.run("return document.querySelector('.meanings').textContent");
    expect(/Stable: the motion does not blow up/.test(meaning), meaning);
  });
  await check("headline, cards, findings and matrix name the same largest steps", async () => {
    const steps = results.findings.find((f) => f.topic === "step size").claims.filter((c) => c.quantity === "largest step for a tolerance");
    expect(steps.length > 0, "the finding states no step");
    const cards = await browser.run("return [...document.querySelectorAll('.card')].map(c => [c.querySelector('h2').firstChild.textContent, c.innerText])");
    for (const [engine, text] of cards) {
      const claim = steps.find((c) => c.engine === engine);
      if (claim) equal(/ up to (\S+) s/.exec(text)?.[1] ?? "", claim.dt ?? "", `${engine}: card and finding`);
    }
    const row = await browser.run(
      "const r = [...document.querySelectorAll('.summary')].find(t => t.innerText.startsWith('step within')), names = [...document.querySelectorAll('.matrix thead .engine')].map(t => t.title.split(': ')[0]); return [...r.querySelectorAll('td')].map((t, i) => [names[i], t.textContent])",
    );
    for (const [engine, text] of row) {
      const claim = steps.find((c) => c.engine === engine);
      if (claim) equal(text, claim.dt ? `${claim.dt} s` : "none", `${engine}: matrix and finding`);
    }
  });
  await check("the tolerance is moved by keys and by hand, and stands in the address", async () => {
    const now = () => browser.run("return document.querySelector('.tolerance').getAttribute('aria-valuenow')");
    const before = Number(await now());
    await browser.run("document.querySelector('.tolerance').focus()");
    await browser.keys("\uE013", "\uE013", "\uE013");
    const after = Number(await now());
    expect(Math.abs(after - before - 0.3) < 0.05, `from 10^${before} to 10^${after}`);
    await browser.until("location.hash.includes('tolerance=')");
    const grip = await boxOf(browser, ".tolerance .grip");
    await browser.drag([[grip.x + 20, grip.y + 10], [grip.x + 20, grip.y + 60], [grip.x + 20, grip.y + 90]]);
    expect(Number(await now()) < after, "dragging down did not lower it");
    await browser.run("location.hash = '#/'");
    await browser.until("document.querySelector('.tolerance').getAttribute('aria-valuenow') === '-3.00'", "the default");
  });
  await check("sorting and filters change the rows and stand in the address", async () => {
    const rows = () => browser.run("return [...document.querySelectorAll('.matrix th.case a')].map(a => a.getAttribute('href').slice(2).split('?')[0])");
    const choose = (label, value) =>
      browser.run(
        "const c = [...document.querySelectorAll('.control')].find(l => l.firstChild.textContent === arguments[0]).querySelector('select'); c.value = arguments[1]; c.dispatchEvent(new Event('change'))",
        label,
        value,
      );
    const all = await rows();
    await choose("Family", "springs");
    equal((await rows()).every((id) => id.startsWith("springs/")), true, "only springs");
    await browser.until("location.hash.includes('family=springs')");
    await choose("Family", "");
    await choose("Sort", "error");
    equal([...(await rows())].sort().join(), [...all].sort().join(), "the same cases");
    await browser.until("location.hash.includes('sort=error')");
    await choose("Sort", "name");
    await choose("Verdict", "bad");
    const failing = await rows();
    const without = await browser.run(
      "return [...document.querySelectorAll('.matrix tr:has(th.case)')].filter(r => !r.querySelector('.is-bad')).length",
    );
    expect(failing.length > 0 && without === 0, `${without} of ${failing.length} rows do not fail`);
    await choose("Verdict", "");
    equal((await rows()).length, all.length, "all again");
  });
  await check("a cell that failed is never marked as stable", async () => {
    const wrong = await browser.run(
      "return [...document.querySelectorAll('.matrix td.cell.is-bad')].filter(c => /stable|✓/.test(c.innerText)).map(c => c.innerText)",
    );
    equal(wrong.length, 0, `cells: ${wrong.join()}`);
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
