// A case with joints: its picture draws them, the note below tells their gaps, and they have a plot.
import { setTimeout as sleep } from "node:timers/promises";
import { check, equal, expect, loaded, open, quiet, shoot } from "./report_page.mjs";

const id = "joints/pendulum-90";

export async function jointedCase(browser) {
  const note = () => browser.run("return document.querySelector('.stage-note').textContent"),
    pressed = () => browser.run("return document.querySelector('[data-flag=joints]')?.getAttribute('aria-pressed')");
  await check("joints are drawn, with the widest gap of each engine in numbers", async () => {
    await open(browser, `#/${id}?dt=1/30&engines=core:rk4&t=0.5`);
    await loaded(browser, id);
    await sleep(300);
    equal(await pressed(), "true", "the flag of the joints");
    expect(/^Widest joint gap: core:rk4 /.test(await note()), `the note says: ${await note()}`);
    const plots = await browser.run("return [...document.querySelectorAll('.plot')].map(p => p.dataset.plot)");
    expect(plots.includes("joint_gap"), `there is no plot of the gap, but of ${plots}`);
    await shoot(browser, "joints");
  });
  await check("i takes the joints away and brings them back", async () => {
    await browser.keys("i");
    await browser.until("document.querySelector('.stage-note').textContent === ''", "the note to go");
    equal(await pressed(), "false", "the flag of the joints");
    await browser.keys("i");
    await browser.until("/gap/.test(document.querySelector('.stage-note').textContent)", "the note to come back");
    await quiet(browser);
  });
  await check("a case without joints has no flag for them", async () => {
    await open(browser, "#/springs/fixed-spring?dt=1/30");
    await loaded(browser, "springs/fixed-spring");
    equal(await pressed(), null, "the flag of the joints");
  });
}
