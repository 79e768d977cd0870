// One case: its picture, its plots, its keys, its addresses; and that every case opens.
import { setTimeout as sleep } from "node:timers/promises";
import {
  boxOf,
  check,
  clock,
  colours,
  equal,
  expect,
  hash,
  loaded,
  open,
  quiet,
  results,
  shoot,
  spring,
} from "./report_page.mjs";

export async function oneCase(browser) {
  await check("a case has its picture, its plots and all its parts", async () => {
    await open(browser, `#/${spring}?dt=1/30`);
    await loaded(browser, spring);
    await sleep(300);
    for (const id of ["numbers", "scheme", "convergence", "work", "stability", "gates", "settings", "file"])
      expect(
        await browser.run("return Boolean(document.getElementById(arguments[0]))", id),
        `the part ${id} is missing`,
      );
    const plots = await browser.run("return [...document.querySelectorAll('.plot')].map(p => p.dataset.plot)");
    for (const name of ["coordinate", "position_error", "orientation_error", "energy_change"]) {
      expect(plots.includes(name), `there is no plot of ${name}`);
      expect((await colours(browser, `.plot[data-plot="${name}"] canvas`)) > 8, `the plot of ${name} is empty`);
    }
    const [first, second, fourth] = await browser.run(
      `return [...document.querySelector("#convergence .chart").querySelectorAll("line.guide")].map((line) => {
        const at = (name) => line[name].baseVal.value;
        return (at("y2") - at("y1")) / (at("x2") - at("x1"));
      })`,
    );
    for (const [order, slope] of [[2, second], [4, fourth]])
      expect(Math.abs(slope / first - order) < 1e-6, `order ${order} is drawn with ${slope / first} times the slope of 1`);
    equal(
      await browser.run("return document.querySelector('#file pre').textContent"),
      results.cases.find((c) => c.id === spring).file + "\n",
      "the case file",
    );
    await shoot(browser, "case-light", true);
  });
  await check("a case has its question, a sketch, its formulas and what to change", async () => {
    const asked = await browser.run("return document.querySelector('.asks').textContent");
    expect(asked.startsWith("How far") && asked.includes("Watch:"), `the question is "${asked}"`);
    for (const part of [".spring", ".solid polygon", "text"])
      expect(await browser.run("return document.querySelectorAll('.scene-sketch ' + arguments[0]).length > 0", part), `the sketch lacks ${part}`);
    const outside = await browser.run(
      "const box = document.querySelector('.scene-sketch').getBoundingClientRect(); return [...document.querySelectorAll('.scene-sketch .solid, .scene-sketch .spring')].filter(e => { const b = e.getBoundingClientRect(); return b.left < box.left || b.right > box.right || b.top < box.top || b.bottom > box.bottom; }).length",
    );
    equal(outside, 0, "parts beyond the sketch");
    const repairs = await browser.run("return [...document.querySelectorAll('.repair')].map(r => r.textContent)");
    const ode = repairs.find((text) => text.startsWith("ode "));
    expect(/dWorldStep\(world, 1\.0 \/ \d+\)/.test(ode), `ODE's own calls are missing: ${ode}`);
    await open(browser, "#/springs/stiff-3?dt=1/30");
    await loaded(browser, "springs/stiff-3");
    const formula = await browser.run("return document.querySelector('.why math')?.textContent ?? ''");
    expect(formula === "ω·Δt=90 rad/s·130 s=3", `the formula is "${formula}"`); // the fraction 1/30 has no bar in its text
    await open(browser, `#/${spring}?dt=1/30`);
    await loaded(browser, spring);
  });
  await check("every plot saves as SVG and as CSV", async () => {
    const files = await browser.run(`
      const kept = [], create = URL.createObjectURL, click = HTMLAnchorElement.prototype.click;
      URL.createObjectURL = (blob) => (kept.push(blob), "blob:kept");
      HTMLAnchorElement.prototype.click = function () {};
      document.querySelectorAll(".save").forEach((button) => button.click());
      (URL.createObjectURL = create), (HTMLAnchorElement.prototype.click = click);
      window.kept = kept;
      return kept.map((blob) => blob.type)`);
    const figures = await browser.run("return document.querySelectorAll('.plot, figure.wide, .frontier, svg.stability').length");
    for (const type of ["image/svg+xml", "text/csv"]) equal(files.filter((f) => f === type).length, figures, type);
    const texts = await browser.callLater("Promise.all(window.kept.map((blob) => blob.text()))");
    for (const [i, text] of texts.entries()) {
      if (files[i] === "text/csv") expect(text.split("\n").length > 3 && text.startsWith("run,"), `a table: ${text.slice(0, 80)}`);
      else expect(/^<svg /.test(text) && /<(path|polyline|rect)/.test(text) && !/NaN|undefined/.test(text), `a picture: ${text.slice(0, 80)}`);
    }
  });
  await check("the picture is drawn with WebGL and shows something", async () => {
    equal(await browser.run("return document.querySelector('.stage canvas').dataset.kind"), "webgl", "kind");
    const picture = await browser.screenshot();
    expect(picture.length > 20000, "the screenshot is all but empty");
  });
  await check("space plays, and picture, clock, plots and address move together", async () => {
    const frames = () => browser.run("return Number(document.querySelector('.stage canvas').dataset.frames)");
    const line = () =>
      browser.run("return new DOMMatrix(getComputedStyle(document.querySelector('.playhead')).transform).m41");
    const [before, framesBefore, lineBefore] = [await clock(browser), await frames(), await line()];
    await browser.keys(" ");
    await sleep(1500);
    await browser.until(
      `Number(document.querySelector('.stage canvas').dataset.frames) > ${framesBefore + 5}`,
      "six frames",
    );
    await browser.until(
      `parseFloat(document.querySelector('.clock').textContent) > ${before + 0.5}`,
      "half a second of playback",
    );
    await browser.keys(" ");
    const [after, framesAfter, lineAfter] = [await clock(browser), await frames(), await line()];
    expect(after > before + 0.5 && after < 5, `the clock went from ${before} to ${after}`);
    console.log(`      ${framesAfter - framesBefore} frames for ${(after - before).toFixed(2)} s of playback`);
    expect(lineAfter > lineBefore + 20, "the plots' line did not move");
    await browser.until(
      `Math.abs(Number(new URLSearchParams(location.hash.split('?')[1]).get('t')) - ${after}) < 2e-3`,
      "the address to have the time",
    );
    await sleep(300);
    equal(await clock(browser), after, "the clock after a pause");
  });
  await check("arrow keys step by dt", async () => {
    await browser.keys("\uE011");
    equal(await clock(browser), 0, "after home");
    await browser.keys("\uE014", "\uE014", "\uE014");
    equal(await clock(browser), 0.1, "after three steps of 1/30 s");
  });
  await check("number keys switch engines, in the picture and in the address", async () => {
    const shown = () =>
      browser.run(
        "return [...document.querySelectorAll('.chip[aria-pressed=true] .name')].map(n => n.textContent).join()",
      );
    const before = await shown();
    await browser.keys("1");
    expect((await shown()) !== before, "key 1 changed nothing");
    await browser.until("location.hash.includes('engines=')");
    await browser.keys("1");
    equal(await shown(), before, "after the second time");
  });
  await check("s puts engines side by side, o overlays them", async () => {
    await browser.keys("s");
    await browser.until("document.querySelectorAll('.panes span').length > 1", "panes to have names");
    await shoot(browser, "case-side-by-side");
    await browser.keys("o");
    await browser.until("document.querySelectorAll('.panes span').length === 0", "names to go");
  });
  await check("moving over a plot sets the time; dragging zooms all plots; z shows the whole", async () => {
    await browser.run("document.querySelector('.plot[data-plot=position_error]').scrollIntoView({block: 'center'})");
    const plot = await boxOf(browser, ".plot[data-plot=position_error] .u-over");
    await browser.hover(plot.x + plot.width * 0.5, plot.y + plot.height / 2);
    const middle = results.cases.find((c) => c.id === spring).duration / 2;
    await browser.until(
      `Math.abs(parseFloat(document.querySelector('.clock').textContent) - ${middle}) < 0.05`,
      "the clock to follow the mouse",
    );
    await browser.drag([
      [plot.x + plot.width * 0.2, plot.y + 40],
      [plot.x + plot.width * 0.5, plot.y + 42],
      [plot.x + plot.width * 0.6, plot.y + 42],
    ]);
    await browser.until("location.hash.includes('zoom=')", "the address to have the zoom");
    await browser.keys("z");
    await browser.until("!location.hash.includes('zoom=')", "the zoom to go");
  });
  await check("dragging the picture turns it", async () => {
    await browser.run("document.querySelector('.stage canvas').scrollIntoView({block: 'center'})");
    const frames = () => browser.run("return Number(document.querySelector('.stage canvas').dataset.frames)");
    const canvas = await boxOf(browser, ".stage canvas"),
      before = await frames(),
      x = canvas.x + canvas.width / 2,
      y = canvas.y + canvas.height / 2;
    await browser.drag([
      [x, y],
      [x + 80, y + 10],
      [x + 120, y + 30],
    ]);
    expect((await frames()) > before, "no frame was drawn");
  });
  await check("d changes the step size and l the scale", async () => {
    await browser.keys("d");
    await browser.until(
      "location.hash.includes('dt=1/240') && document.querySelector('.view').dataset.loaded.endsWith('1/240')",
      "1/240",
    );
    await browser.keys("l");
    await browser.until("location.hash.includes('log=0')");
    await browser.keys("l");
  });
  await check("j, k and escape go from case to case", async () => {
    const at = results.cases.findIndex((c) => c.id === spring),
      next = results.cases[at + 1] ?? results.cases[at - 1];
    await browser.keys(results.cases[at + 1] ? "j" : "k");
    await browser.until(`location.hash.startsWith('#/${next.id}')`, next.id);
    await browser.keys("\uE00C");
    await browser.until("document.querySelector('.matrix')", "the matrix");
    await browser.run("history.back()");
    await browser.until(`location.hash.startsWith('#/${next.id}') && document.querySelector('.stage')`, "the way back");
  });
  await check("an address opens the view it names", async () => {
    await open(browser, `#/${spring}?dt=1/240&engines=ode~core:rk4&t=1.25&layout=side&log=0&zoom=1~2`);
    await loaded(browser, spring);
    await sleep(200);
    equal(await clock(browser), 1.25, "time");
    equal(
      await browser.run(
        "return [...document.querySelectorAll('.chip[aria-pressed=true] .name')].map(n => n.textContent).sort().join()",
      ),
      "ode,rk4",
      "engines",
    );
    equal(
      await browser.run("return document.querySelector('.segments [aria-pressed=true]').textContent"),
      "dt 1/240 s",
      "step",
    );
    equal(await browser.run("return document.querySelectorAll('.panes span').length"), 2, "panes");
    expect((await hash(browser)).includes("zoom=1~2"), "the zoom is lost");
  });
  await check("addresses that name what is not there are told so", async () => {
    await open(browser, "#/no/such%20case?dt=7&t=x&zoom=a~b");
    expect((await browser.run("return document.body.textContent")).includes("No such case"), "no word of it");
    await open(browser, `#/${spring}?dt=nonsense&engines=nobody&t=1e9&zoom=5~1`);
    await loaded(browser, spring);
  });
  await check("nothing was complained of in a case", () => quiet(browser));
}

// Every case at its coarsest step, with all its engines, opens and plays without solver_warning.
export async function everyCase(browser) {
  for (const one of results.cases.slice(0, 12)) {
    await check(`${one.id} opens with all engines`, async () => {
      const engines = results.cells.filter((c) => c.case === one.id).map((c) => c.engine);
      await open(
        browser,
        `#/${encodeURIComponent(one.id)}?engines=${[...new Set(engines)].map(encodeURIComponent).join("~")}&t=${one.duration / 3}`,
      );
      await loaded(browser, one.id);
      await browser.keys(" ");
      await sleep(250);
      await browser.keys(" ");
      await quiet(browser);
    });
  }
}
