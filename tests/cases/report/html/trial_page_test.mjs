// The trials of a recording in the report: each can be chosen and played, and every trial's error is a dot.
// node trial_page_test.mjs REPORT.html RESULTS.json SHOTS-FOLDER
import { Browser } from "./browser.mjs";
import { check, clock, equal, expect, loaded, open, quiet, results, shoot, summed } from "./report_page.mjs";

const id = "reality/synthetic-tosses",
  cells = results.cells.filter((cell) => cell.case === id && cell.dt === "1/296"),
  names = cells[0].trials.map((row) => row.trial);
const errorOf = (engine, trial) =>
  cells.find((cell) => cell.engine === engine).trials.find((row) => row.trial === trial).metrics.mean_position_error;

const browser = await Browser.open();
const played = () => browser.run("return document.querySelector('[aria-label=\"Trial played\"]')?.value ?? null");
const shown = (trial) => loaded(browser, `${id} 1/296 ${trial}`);
// The numbers beside the engines, also beside one whose verdict on all trials is bad.
const chips = () =>
  browser.run(`return [...document.querySelectorAll('.chip')].map((chip) =>
    [chip.querySelector('.name').textContent, parseFloat(chip.querySelector('.word').textContent.replace(/^[^0-9]+/, ""))])`);
// A coordinate of the truth and of the engines, at the time shown.
const places = () =>
  browser.run("return [...document.querySelectorAll('[data-plot=coordinate] .readouts > span')].map((s) => s.textContent)");

try {
  await check("the first trial is played at first, and its own error stands beside each engine", async () => {
    await open(browser, `#/${id}?dt=1/296&t=0.15`);
    await shown(names[0]);
    equal(await played(), names[0], "the trial");
    const told = await chips();
    equal(told.length, 2, "engines");
    for (const [engine, value] of told)
      expect(Math.abs(value / errorOf(engine, names[0]) - 1) < 0.06, `${engine}: ${value} of ${errorOf(engine, names[0])}`);
  });
  await check("each trial has a dot for each engine, at its error", async () => {
    const dots = await browser.run(
      "return [...document.querySelectorAll('.trial-spread circle')].map((dot) => [dot.dataset.trial, Number(dot.getAttribute('cx')), dot.textContent])",
    );
    equal(dots.length, cells.length * names.length, "dots");
    const ofOde = dots.filter(([, , text]) => text.startsWith("ode,")).sort((a, b) => a[1] - b[1]).map(([trial]) => trial);
    const sorted = [...names].sort((a, b) => errorOf("ode", a) - errorOf("ode", b));
    equal(ofOde.join(), sorted.join(), "the order of the dots");
  });
  await check("a dot plays its trial, with another truth and other motions", async () => {
    const before = await places();
    await browser.run("[...document.querySelectorAll('.trial-spread circle')].find((dot) => dot.dataset.trial === arguments[0]).dispatchEvent(new MouseEvent('click', {bubbles: true}))", names[3]);
    await shown(names[3]);
    equal(await played(), names[3], "the trial");
    await browser.until(`location.hash.includes(${JSON.stringify(`trial=${names[3]}`)})`, "the address to name the trial");
    const after = await places();
    equal(after.length, before.length, "lines");
    after.forEach((text, i) => expect(text !== before[i], `line ${i} did not change: ${before} and ${after}`));
    await shoot(browser, "trial");
  });
  await check("the playback ends with the trial", async () => {
    await browser.keys("\uE010"); // the End key
    equal(await clock(browser), 0.6, "the end [s]");
  });
  await check("keys and buttons go to other trials", async () => {
    await browser.keys(".");
    await shown(names[4]);
    await browser.keys(","), await browser.keys(",");
    await shown(names[2]);
    await browser.run("[...document.querySelectorAll('.trials button')].find((b) => b.textContent === 'farthest').click()");
    const first = (await browser.run("return document.querySelector('.chip[aria-pressed=true] .name').textContent"));
    const farthest = [...names].sort((a, b) => errorOf(first, b) - errorOf(first, a))[0];
    await shown(farthest);
    equal(await played(), farthest, "the farthest trial");
    await quiet(browser);
  });
  await check("an unknown trial in the address shows the first", async () => {
    await open(browser, `#/${id}?dt=1/296&trial=none-such`);
    await shown(names[0]);
    equal(await played(), names[0], "the trial");
  });
  await check("no truth past its horizon is told, and the printed commands suit a recording", async () => {
    const text = await browser.run("return document.querySelector('.view').textContent");
    expect(!text.includes("past its horizon"), "the horizon of a recording");
    expect(!text.includes("rigor tune"), "rigor tune");
    expect(text.includes(`rigor fit ${id} --engine ode --dt 1/296 --vary scene.contact_default.friction`), "rigor fit");
  });
  await check("a case without trials has neither the list nor the dots", async () => {
    await open(browser, "#/springs/fixed-spring");
    await loaded(browser, "springs/fixed-spring");
    equal(await played(), null, "the list of trials");
    equal(await browser.run("return document.querySelectorAll('.trial-spread').length"), 0, "figures");
  });
} finally {
  await browser.close();
}
process.exit(summed());
