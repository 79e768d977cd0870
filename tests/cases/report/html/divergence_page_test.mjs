// Tests the words and plots of the page of `rigor diverge --out`, and that names in it are text.
//
// node divergence_page_test.mjs REPORT.html RESULTS.json SHOTS-FOLDER
//
// Beside the report's folder are those of other pages: steps, never, spread, same, unmeasured.
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";
import { boxOf, check, clock, equal, expect, quiet, report, shoot, summed } from "./report_page.mjs";

const modules = process.env.RIGOR_PAGE_MODULES;
const harm = "</script><img src=x onerror=window.harm=1>";
const found = JSON.parse(readFileSync(join(dirname(report), "divergence.json"), "utf8"));

const browser = await Browser.open({ width: 1400, height: 900 });
const text = (selector) => browser.run("return document.querySelector(arguments[0])?.textContent ?? ''", selector);
const count = (selector) => browser.run("return document.querySelectorAll(arguments[0]).length", selector);

async function openPage(folder) {
  await browser.goTo("about:blank");
  await browser.goTo(pathToFileURL(join(dirname(report), "..", folder, "report.html")).href);
  await browser.until("document.querySelector('.view')?.dataset.loaded", "the case to be loaded");
}

// How many pixels of the picture have the colour of the first run, and of the second one.
async function inkOf(first, second) {
  const isOn = (n) => browser.run("return document.querySelectorAll('.chip[aria-pressed]')[arguments[0]].getAttribute('aria-pressed') === 'true'", n);
  for (const [n, wanted] of [first, second].entries()) if ((await isOn(n)) !== wanted) await browser.keys(String(n + 1));
  const frames = await browser.run("return Number(document.querySelector('.stage canvas').dataset.frames)");
  await browser.keys("f");
  await browser.until(`Number(document.querySelector('.stage canvas').dataset.frames) > ${frames}`, "a frame");
  const clip = await boxOf(browser, ".stage canvas");
  const { data } = await browser.devtools("Page.captureScreenshot", { format: "png", clip: { ...clip, scale: 1 } });
  await browser.run("window.shot = arguments[0]", data);
  return browser.callLater(`(async () => {
    const bytes = Uint8Array.from(atob(window.shot), (c) => c.charCodeAt(0)),
      image = await createImageBitmap(new Blob([bytes]));
    const copy = document.createElement("canvas");
    (copy.width = image.width), (copy.height = image.height);
    const pen = copy.getContext("2d");
    pen.drawImage(image, 0, 0);
    const { data } = pen.getImageData(0, 0, copy.width, copy.height);
    let red = 0, blue = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i] > data[i + 2] + 40) ++red;
      if (data[i + 2] > data[i] + 40) ++blue;
    }
    return { red, blue };
  })()`);
}

async function passesAxe() {
  await browser.run(readFileSync(join(modules, "axe-core/axe.min.js"), "utf8") + "; window.axe = axe;");
  const { violations } = await browser.callLater("axe.run(document, {resultTypes: ['violations']})");
  expect(!violations.length, violations.map((v) => `${v.id}: ${v.help} ${v.nodes[0]?.html.slice(0, 120)}`).join("\n"));
}

try {
  await check("it opens where the runs part, with the answer first", async () => {
    await openPage("parted");
    const { time, body } = found.parting;
    expect(Math.abs((await clock(browser)) - time) < 1e-3, `the clock is at ${await clock(browser)}, they part at ${time}`);
    equal(await text(".answer-first h1"), `ode and ode,gyroscopic=off part at ${Number(time.toPrecision(4))} s`, "the answer");
    const answer = await text(".answer-first");
    expect(answer.includes(`“${harm}” is then`) && body === harm, `the body's name is not text: ${answer}`);
    expect(/ is nearer\./.test(answer) && !answer.includes("off is nearer"), `the truth's word: ${answer}`);
    equal(await browser.run("return window.harm ?? null"), null, "what a name has run");
    await shoot(browser, "divergence", true);
  });
  await check("both motions are drawn over each other", async () => {
    await browser.keys("\uE010"); // to the end, where they are far apart
    await browser.run("scrollTo(0, 0)");
    const [both, first, second] = [await inkOf(true, true), await inkOf(true, false), await inkOf(false, true)];
    const words = JSON.stringify({ both, first, second });
    expect(first.red > 1000 && first.blue < 0.01 * first.red, `the first run is not red: ${words}`);
    expect(second.blue > 1000 && second.red < 0.01 * second.blue, `the second run is not blue: ${words}`);
    expect(both.red > 0.1 * first.red && both.blue > 0.1 * second.blue, `one of them is missing: ${words}`);
    await inkOf(true, true);
    equal(await count(".panes span"), 0, "panes beside each other");
  });
  await check("the plot crosses the bound when they part, and not before", async () => {
    const { points, boundY, partX } = await browser.run(`
      const at = (selector, name) => Number(document.querySelector(".parting-chart " + selector).getAttribute(name));
      return {
        points: document.querySelector(".parting-chart .gap").getAttribute("points").split(" ").map((p) => p.split(",").map(Number)),
        boundY: at(".bound", "y1"), partX: at(".parts-at", "x1") }`);
    const pixel = 0.06; // coordinates are written to 0.1
    const before = points.filter(([x]) => x < partX - pixel);
    expect(before.length > 3 && before.every(([, y]) => y > boundY - pixel), "the line is beyond the bound before they part");
    const then = points.filter(([x]) => Math.abs(x - partX) <= pixel);
    expect(then.some(([, y]) => y < boundY), "the line is within the bound when they part");
    equal(await count(".parting-chart .one-step"), found.injections.steps.length, "one-step differences");
    equal(await text(".parting-chart .parts-text"), `they part at ${Number(found.parting.time.toPrecision(4))} s`, "the label");
  });
  await check("causes and settings are in tables, with the best one and its calls", async () => {
    equal(await count(".causes tbody tr"), found.causes.length, "causes");
    expect((await text(".causes")).includes(`the gyroscopic term of '${harm}'`), await text(".causes"));
    equal(await count(".swaps tbody tr"), found.swaps.length, "settings");
    equal(await count(".swaps .is-best"), 1, "best settings");
    expect((await text(".swaps .is-best")).startsWith("gyroscopic: off → on of ode,gyroscopic=off"), await text(".swaps .is-best"));
    expect((await text("#divergence pre code")).includes("dWorldStep"), "the engine's calls are missing");
    equal(await text("#divergence p code"), found.command, "the command");
  });
  await check("a click on the plot sets the time, and a key its range", async () => {
    await browser.run("document.querySelector('.parting-chart').scrollIntoView({ block: 'center' })");
    const box = await boxOf(browser, ".parting-chart"),
      y = box.y + box.height / 2;
    await browser.drag([[box.x + box.width / 2, y], [box.x + box.width / 2, y]]);
    const time = await clock(browser);
    expect(time > 0.5 * found.parting.time && time < found.parting.time, `the clock is at ${time}`);
    await browser.run("document.querySelector('.parting figcaption button').focus()");
    await browser.keys("\uE007");
    equal(await text(".parting figcaption button"), "only until they part", "the button");
    equal(await browser.run("return document.querySelector('.parting-chart .gap').getAttribute('points').split(' ').length"), found.gap.time.length, "samples of the whole time");
  });
  await check("the plot saves as SVG and as CSV", async () => {
    await browser.run(`
      window.kept = [];
      const create = URL.createObjectURL, click = HTMLAnchorElement.prototype.click;
      URL.createObjectURL = (blob) => (window.kept.push(blob), "blob:kept");
      HTMLAnchorElement.prototype.click = function () {};
      document.querySelectorAll(".parting .save").forEach((button) => button.click());
      (URL.createObjectURL = create), (HTMLAnchorElement.prototype.click = click)`);
    const [picture, table] = await browser.callLater("Promise.all(window.kept.map((blob) => blob.text()))");
    expect(/^<svg /.test(picture) && picture.includes("<polyline") && !/NaN|undefined/.test(picture), picture.slice(0, 80));
    equal(table.trim().split("\n").length, 1 + found.gap.time.length + found.injections.steps.length, "rows of the table");
  });
  for (const [name, width, dark] of [["wide", 1400, false], ["narrow", 400, true]]) {
    await check(`${name}: nothing is too wide, and axe-core finds nothing`, async () => {
      await browser.emulate(width, 850, { dark, touch: width < 500 });
      await openPage("parted");
      equal(await browser.run("return document.documentElement.dataset.theme"), dark ? "dark" : "light", "theme");
      const over = await browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth");
      expect(over <= 0, `the page is ${over} pixels too wide`);
      await passesAxe();
      await quiet(browser);
      await shoot(browser, `divergence-${name}`, true);
    });
  }
  await browser.emulate(1400, 900);
  await check("two steps of one engine are shown one at a time, and the page says so", async () => {
    await openPage("steps");
    equal(await count(".segments button"), 2, "steps");
    equal(await text(".segments [aria-pressed=true]"), "dt 1/100 s", "the step shown");
    expect((await text(".answer-first h1")).startsWith("core:semi-implicit-euler at 1/100 s and core:semi-implicit-euler at 1/50 s part at"), await text(".answer-first h1"));
    expect((await text("#divergence")).includes("one step size at a time"), "no word of it");
    await quiet(browser);
  });
  await check("runs that never part have their gap, and no instant", async () => {
    await openPage("never");
    expect((await text(".answer-first h1")).endsWith("do not part"), await text(".answer-first h1"));
    expect((await text(".answer-first")).includes("of the bound"), await text(".answer-first"));
    equal(await count(".parts-at, .causes, .swaps"), 0, "parts of a page where runs part");
    equal(await count(".parting-chart .gap"), 1, "plots");
    await quiet(browser);
  });
  await check("the same numbers are said, not plotted", async () => {
    await openPage("same");
    expect((await text(".answer-first")).includes("The gap is 0 at each of the instants compared"), await text(".answer-first"));
    expect((await text("#divergence")).includes("nothing to plot"), await text("#divergence"));
    equal(await count(".parting-chart"), 0, "plots");
    await quiet(browser);
  });
  await check("what was not measured is said in sentences", async () => {
    await openPage("unmeasured");
    const answer = await text(".answer-first"),
      part = await text("#divergence");
    expect(answer.includes("No truth says which run is right: the case has no truth.") && answer.includes("4 mrad apart, most in turn about y. The bound is 1 mrad."), answer);
    expect(part.includes("What each step adds was not measured: a run crashed.") && part.includes("No setting differs between the runs."), part);
    equal(await count(".parting-chart .one-step, .causes, .swaps"), 0, "parts of a page with measurements");
    expect(!/undefined|NaN|null/.test(answer + part), `${answer} ${part}`);
    await quiet(browser);
  });
  await check("a gap that repeats explain is not called none; names of runs are text", async () => {
    await openPage("spread");
    const answer = await text(".answer-first");
    expect(answer.includes("leave the bound, but so do their repeats") && !answer.includes("do not part"), answer);
    expect(answer.includes("The gap reaches 4 of the bound, at 0.5 s") && answer.includes("up to 2 of the bound"), answer);
    expect(answer.includes(`${harm} blows up at 1.1 s`), answer);
    equal(await browser.run("return window.harm ?? null"), null, "what a name has run");
    await quiet(browser);
  });
} finally {
  await browser.close();
}
process.exit(summed());
