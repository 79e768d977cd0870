// The report in a headless Chromium, as a reader would use it: node page_test.mjs REPORT.html RESULTS.json SHOTS-FOLDER
// Says of each check whether it passed; the exit code is 0 if all did. Screenshots stay in the folder.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { setTimeout as sleep } from "node:timers/promises";
import { Browser } from "./browser.mjs";

const [report, resultsFile, shots] = process.argv.slice(2);
const url = pathToFileURL(report).href,
  results = JSON.parse(readFileSync(resultsFile, "utf8"));
mkdirSync(shots, { recursive: true });

let passed = 0,
  failed = 0;
async function check(name, body) {
  try {
    await body();
    ++passed;
    console.log(`ok    ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAIL  ${name}: ${error.message}`);
  }
}
function expect(condition, message) {
  if (!condition) throw new Error(message);
}
const equal = (found, wanted, what) =>
  expect(found === wanted, `${what}: found ${JSON.stringify(found)}, expected ${JSON.stringify(wanted)}`);

// Chromium tells of screenshots that they cost time; of the page it must have nothing to say.
async function quiet(browser) {
  const complaints = (await browser.complaints()).filter((text) => !text.includes("GPU stall due to ReadPixels"));
  expect(!complaints.length, complaints.join("\n"));
}
const shoot = async (browser, name, whole = false) =>
  writeFileSync(join(shots, `${name}.png`), await browser.screenshot({ whole }));
const ready = (browser) => browser.until("document.documentElement.dataset.ready === 'true'", "the page to be ready");
const loaded = (browser, id) =>
  browser.until(
    `document.querySelector('.view').dataset.loaded?.startsWith(${JSON.stringify(id)})`,
    `${id} to be loaded`,
  );
// Fresh, even where only what stands behind the "#" differs.
async function open(browser, hash = "") {
  await browser.goTo("about:blank");
  await browser.goTo(url + hash);
  await ready(browser);
}
const clock = (browser) => browser.run("return parseFloat(document.querySelector('.clock').textContent)");
const hash = (browser) => browser.run("return location.hash");
const boxOf = (browser, selector) =>
  browser.run(
    "const r = document.querySelector(arguments[0]).getBoundingClientRect(); return {x: r.x, y: r.y, width: r.width, height: r.height}",
    selector,
  );
// How many different colours a canvas of the page shows.
const colours = (browser, selector) =>
  browser.run(
    `
  const from = document.querySelector(arguments[0]), copy = document.createElement("canvas");
  copy.width = 160, copy.height = 100;
  const pen = copy.getContext("2d");
  pen.drawImage(from, 0, 0, 160, 100);
  return new Set(new Uint32Array(pen.getImageData(0, 0, 160, 100).data.buffer)).size`,
    selector,
  );

const spring = "springs/fixed-spring";

async function firstScreen(browser) {
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
      "return [...document.querySelectorAll('.intro .findings li')].map(li => li.textContent)",
    );
    equal(JSON.stringify(texts), JSON.stringify(results.findings), "sentences");
    expect(texts.length > 0, "there are none");
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

async function oneCase(browser) {
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
    equal(
      await browser.run("return document.querySelector('#file pre').textContent"),
      results.cases.find((c) => c.id === spring).file + "\n",
      "the case file",
    );
    await shoot(browser, "case-light", true);
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

// Every case at its coarsest step, with all its engines, opens and plays without complaint.
async function everyCase(browser) {
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

async function looks() {
  for (const [name, options, address] of [
    ["first-light", {}, ""],
    ["first-dark", { dark: true }, ""],
    ["case-dark", { dark: true }, `#/${spring}?t=1.5`],
    ["first-phone", { width: 390, height: 844, touch: true }, ""],
    ["case-phone", { width: 390, height: 844, touch: true, dark: true }, `#/${spring}?t=1.5`],
  ]) {
    const browser = await Browser.open({ width: 1360, height: 900, ...options });
    await check(`${name}: nothing runs over the page's edge, and the theme is the system's`, async () => {
      await open(browser, address);
      if (address) await loaded(browser, spring);
      await sleep(400);
      await shoot(browser, name, name === "case-phone");
      equal(
        await browser.run("return document.documentElement.dataset.theme"),
        options.dark ? "dark" : "light",
        "theme",
      );
      const over = await browser.run(
        "return document.documentElement.scrollWidth - document.documentElement.clientWidth",
      );
      expect(over <= 0, `the page is ${over} pixels too wide`);
      await quiet(browser);
    });
    if (options.touch && address) {
      await check("a finger turns the picture and sets the time in a plot", async () => {
        await browser.run("document.querySelector('.stage canvas').scrollIntoView({block: 'center'})");
        const frames = () => browser.run("return Number(document.querySelector('.stage canvas').dataset.frames)");
        const canvas = await boxOf(browser, ".stage canvas"),
          before = await frames();
        await browser.drag(
          [
            [canvas.x + 80, canvas.y + 100],
            [canvas.x + 140, canvas.y + 102],
            [canvas.x + 220, canvas.y + 104],
          ],
          { pointerType: "touch" },
        );
        expect((await frames()) > before, "the picture did not turn");
        await browser.run(
          "document.querySelector('.plot[data-plot=position_error]').scrollIntoView({block: 'center'})",
        );
        const plot = await boxOf(browser, ".plot[data-plot=position_error] .u-over"),
          was = await clock(browser);
        await browser.drag(
          [
            [plot.x + plot.width * 0.7, plot.y + 30],
            [plot.x + plot.width * 0.8, plot.y + 31],
          ],
          { pointerType: "touch" },
        );
        expect((await clock(browser)) !== was, "the time did not change");
      });
    }
    if (name === "first-light") {
      await check("it prints", async () => {
        const { data } = await browser.devtools("Page.printToPDF", { printBackground: true, preferCSSPageSize: true });
        writeFileSync(join(shots, "first.pdf"), Buffer.from(data, "base64"));
        expect(data.length > 10000, "the PDF is all but empty");
      });
    }
    await browser.close();
  }
}

async function withoutWebgl() {
  const browser = await Browser.open({ webgl: false });
  await check("without WebGL the picture is drawn with lines, and says why", async () => {
    await open(browser, `#/${spring}?t=1`);
    await loaded(browser, spring);
    await sleep(300);
    equal(await browser.run("return document.querySelector('.stage canvas').dataset.kind"), "canvas", "kind");
    expect(
      (await browser.run("return document.querySelector('.stage-note').textContent")).includes("WebGL"),
      "no word of it",
    );
    expect((await colours(browser, ".stage canvas")) > 8, "the picture is empty");
    await shoot(browser, "case-without-webgl");
    const complaints = (await browser.complaints()).filter((text) => !/webgl/i.test(text)); // Chromium's own word that there is none
    expect(!complaints.length, complaints.join("\n"));
  });
  await browser.close();
}

const browser = await Browser.open();
try {
  await firstScreen(browser);
  await oneCase(browser);
  await everyCase(browser);
} finally {
  await browser.close();
}
await looks();
await withoutWebgl();
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
