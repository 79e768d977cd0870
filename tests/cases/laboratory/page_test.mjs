// Tests the laboratory in a headless Chromium: every control, as a student would use it.
//   node page_test.mjs PAGE.html SHOTS-FOLDER FOLDER-OF-node_modules
// Prints the result of each check; the exit code is 0 if all passed. Screenshots stay in the folder.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import {
  atStep,
  browser,
  check,
  click,
  expect,
  finish,
  hash,
  inAddress,
  matches,
  modules,
  open,
  pick,
  quiet,
  run,
  shoot,
  slide,
  step,
  text,
  until,
} from "./page_driver.mjs";

await finish(async () => {
  await check("it is usable within two seconds, without a word in the console", async () => {
    await open();
    const took = Number(await run("return document.documentElement.dataset.ready"));
    console.log(`      usable after ${took} ms`);
    expect(took < 4000, `it took ${took} ms`); // 2 s on a machine that does nothing else
    await quiet();
  });
  await check("the truth is solved, and named with its own error", async () => {
    await until("document.querySelector('#truth-note').textContent.startsWith('Truth: reference')", "the truth");
  });
  await check("one step makes one step", async () => {
    await click("#step");
    await atStep(1);
    matches(await text("#clock"), /^0\.033 s/, "the clock");
    await inAddress("at=1");
  });
  await check("play plays, pause stops, and the reason for the explosion is said", async () => {
    await pick("#speed", "4");
    await click("#play");
    await until("Number(document.querySelector('main').dataset.step) > 20", "steps");
    await click("#play");
    const stopped = await step();
    await new Promise((done) => setTimeout(done, 400));
    expect((await step()) - stopped <= 8, "it went on"); // a call in flight ends
    await click("#play");
    await atStep(150);
    await until("/grows by a factor of 1.43/.test(document.querySelector('#sentence').textContent)", "the sentence");
    matches(await text("[data-run='core:explicit-euler'] .word"), /blown up/, "the verdict");
    await shoot("spring-1400");
  });
  await check("every plot has its lines, and the errors differ", async () => {
    const names = await run(
      "return [...document.querySelectorAll('.plot:not(.is-empty)')].map((one) => one.dataset.plot)",
    );
    for (const name of ["energy", "position", "orientation"]) expect(names.includes(name), `no plot of ${name}`);
    const values = await run(
      "return [...document.querySelectorAll('[data-plot=position] .readouts b')].map((one) => one.textContent)",
    );
    expect(new Set(values).size === 3, `the readouts are ${values}`);
  });
  await check("back to the start sets all to zero", async () => {
    await click("#reset");
    await atStep(0);
    expect(!(await hash()).includes("at="), "the address keeps the step");
  });
  await check("the slider of dt changes the step", async () => {
    await slide("#dt", 14);
    await inAddress("dt=1/240");
    await click("#step");
    await atStep(1);
    matches(await text("#clock"), /^0\.004 s/, "the clock");
  });
  await check("stiffness, damping, mass and gravity change the scene, and its own values come back", async () => {
    for (const [name, value] of [
      ["stiffness", 5],
      ["damping", 300],
      ["mass", 1],
      ["gravity", 5],
    ]) {
      await slide(`#knob-${name}`, value);
      await inAddress(`${name}=`);
    }
    const before = await text("label[for='knob-stiffness'] + output");
    matches(before, /N\/m/, "the stiffness");
    await click("#own-values");
    await until("!location.hash.includes('stiffness')", "its own values");
    expect((await text("label[for='knob-stiffness'] + output")) !== before, "the stiffness stays");
  });
  await check("a method can be chosen, added and removed", async () => {
    await pick(".run-row:nth-of-type(1) select", "velocity-verlet");
    await inAddress("core:velocity-verlet~");
    await click("#add-run");
    await until("document.querySelectorAll('.run-row').length === 4", "four methods");
    expect(!(await run("return document.querySelector('#add-run')")), "a fifth can be added");
    await click(".run-row:nth-of-type(4) button");
    await until("document.querySelectorAll('.run-row').length === 3", "three methods");
  });
  await check("side by side and overlaid, ghost on and off", async () => {
    await click("#layout");
    await until("document.querySelectorAll('.panes span').length === 3", "three panes");
    await inAddress("layout=side");
    await click("#layout");
    await until("document.querySelectorAll('.panes span').length === 0", "one picture");
    await click("#flag-truth");
    await inAddress("truth=0");
    await click("#flag-truth");
  });
  await check("keys: space, right, r, s, o, g, l, f, +, -, <, >, ?", async () => {
    await run("document.activeElement.blur()");
    for (const [key, part] of [
      ["s", "layout=side"],
      ["g", "truth=0"],
      ["l", "log=0"],
      ["<", "dt=1/300"],
    ]) {
      await browser.keys(key);
      await inAddress(part);
    }
    await browser.keys("o", "g", "l", ">", "f");
    await inAddress("dt=1/240");
    await browser.keys("-");
    await inAddress("speed=2");
    await browser.keys("+", "\uE014");
    await atStep(1);
    await browser.keys("r");
    await atStep(0);
    await browser.keys(" ");
    await until("Number(document.querySelector('main').dataset.step) > 5", "steps by the keyboard");
    await browser.keys(" ");
    await browser.keys("?");
    await until("document.querySelector('dialog[open]')", "the keys");
    await run("document.querySelector('dialog button').click()");
  });
  await check("an orientation update can be chosen, and loses orthonormality", async () => {
    await open("#/ballistic/orientation-updates?runs=core:semi-implicit-euler&dt=1/30");
    await pick("[data-option=orientation]", "matrix-additive");
    await inAddress("orientation=matrix-additive");
    await pick("#speed", "4");
    await click("#play");
    await atStep(300);
    matches(await text("[data-plot=orthonormality] .readouts b"), /^3\.9/, "|RᵀR − I|"); // the case's gate: 3.935
    await shoot("orientation-1400");
  });
  await check("the gap of a joint is drawn beside energy and errors, and is the metric's", async () => {
    await open("#/joints/pendulum-90?runs=core:ode-twin~core:velocity-verlet&dt=1/60");
    await pick("#speed", "4");
    await click("#play");
    await until("Number(document.querySelector('main').dataset.step) >= 60", "60 steps");
    await click("#play");
    const gaps = await run(
      "return [...document.querySelectorAll('[data-plot=gap] .readouts b')].map((one) => one.textContent)",
    );
    expect(gaps.length === 2, `two runs, but ${gaps.length} readouts`);
    matches(gaps[0], /^\d.*[mµ]m$/, "the gap of ODE's scheme");
    matches(gaps[1], /^≈ 0$/, "the gap of the core's projection");
    await shoot("gap-1400");
    await open("#/springs/fixed-spring?runs=core:rk4");
    expect(await run("return document.querySelector('[data-plot=gap]').classList.contains('is-empty')"), "a gap without joints");
  });
  await check("restitution, friction and the contact method act on a collision", async () => {
    await pick("#scene", "contact/collision");
    await until("document.querySelector('#knob-restitution')", "the slider");
    await pick("[data-option=contact]", "course");
    await inAddress("contact=course");
    await slide("#knob-restitution", 1);
    await inAddress("restitution=1");
    await click("#knob-friction-infinite");
    await inAddress("friction=0.5");
    await slide("#knob-friction", 0.2);
    await inAddress("friction=0.2");
    await click("#knob-friction-infinite");
    await until("!location.hash.includes('friction')", "the scene's own friction, which is infinite");
    await click("#play");
    await until("Number(document.querySelector('main').dataset.step) > 60", "bounces");
    await click("#play");
    await shoot("collision-1400");
  });
  await check("a link shows the same to somebody else, bit by bit", async () => {
    await open("#/springs/fixed-spring?runs=core:rk4~core:velocity-verlet&dt=1/60&stiffness=20000&layout=side&at=77");
    await atStep(77);
    await until(
      "document.querySelectorAll('.now td').length > 0 && !document.querySelector('.now').textContent.includes('–')",
      "figures",
    );
    const first = await text(".now");
    await open(await run("return location.hash"));
    await atStep(77);
    await until(`document.querySelector('.now').textContent === ${JSON.stringify(first)}`, "the same figures");
  });
  await check("wrong parts of an address become the nearest valid ones, and are told", async () => {
    await open(
      "#/springs/fixed-sprin?runs=core:explicit-eular,orientation=matrix-aditive&dt=1/31&stiffness=1e99&colour=3&mass=x&speed=3",
    );
    const told = await text(".told");
    for (const part of [
      "fixed-sprin",
      "explicit-euler",
      "matrix-additive",
      "1/30 s",
      "out of range",
      "colour",
      "Mass",
      "speed",
    ])
      expect(told.includes(part), `not told: ${part}, in "${told}"`);
    await inAddress("core:explicit-euler,orientation=matrix-additive");
  });
  await check("a name of markup runs no script", async () => {
    await open("#/%3Cimg src=x onerror=alert(1)%3E?runs=%3Cscript%3Ealert(1)%3C/script%3E");
    expect(!(await run("return document.querySelector('main img, main script')")), "markup came in");
    await quiet();
  });
  for (const id of await run(
    "return [...document.querySelectorAll('[data-lesson]')].map((one) => one.dataset.lesson)",
  )) {
    await check(`lesson ${id}: five screens, each with its figures`, async () => {
      await open();
      await click(`[data-lesson=${id}]`);
      for (let screen = 1; screen <= 5; ++screen) {
        await inAddress(`lesson=${id}.${screen}`);
        await pick("#speed", "4");
        await click("#play");
        await until(
          "document.querySelector('#play').ariaLabel === 'Play' && Number(document.querySelector('main').dataset.step) > 0",
          "its end",
          40,
        );
        await until(
          "document.querySelectorAll('.figure-now').length > 0 && [...document.querySelectorAll('.figure-now')].every((one) => one.textContent !== '…')",
          "figures",
        );
        expect((await text(".told")) === "", `told: ${await text(".told")}`);
        await shoot(`lesson-${id}-${screen}`);
        if (screen < 5) await click("[data-go=next]");
      }
      await click("[data-go=back]");
      await inAddress(`lesson=${id}.4`);
      await click("[data-go=again]");
      await atStep(0);
      await click("[data-go=leave]");
      await until("!location.hash.includes('lesson')", "the end of the lesson");
      await quiet();
    });
  }
  await check("ODE and Bullet run beside the core, and each is what it is", async () => {
    await open("#/springs/fixed-spring?runs=core:rk4~ode&dt=1/60");
    await click("#add-run"), await until("document.querySelectorAll('.run-row').length === 3", "a third run");
    await pick(".run-row:nth-of-type(3) select", "bullet");
    await inAddress("~ode~bullet");
    const names = await run(
      "return [...document.querySelectorAll('.run-row:nth-of-type(2) option')].map((one) => one.textContent)",
    );
    for (const name of [/^ode 0\.16/, /^bullet 3\.24/])
      expect(names.some((one) => name.test(one)), `no ${name} among ${names.join(", ")}`);
    await until("!document.querySelector('.now').textContent.includes('–')", "figures of all", 30);
    await pick("#speed", "4");
    await click("#play");
    await atStep(300);
    for (const name of ["ode", "bullet"])
      matches(await text(`.now [data-run='${name}'] td:nth-of-type(2)`), /m$/, `the error of ${name}`);
    await shoot("ode-bullet-1400");
    await quiet();
  });
  for (const [width, dark] of [
    [1400, false],
    [400, true],
  ]) {
    await check(`at ${width} px nothing is too wide, and axe-core finds nothing`, async () => {
      await browser.emulate(width, 900, { dark, touch: width < 600 });
      await open(
        "#/springs/body-springs?runs=core:rk4~core:semi-implicit-euler,orientation=matrix-rodrigues&dt=1/60&at=40",
      );
      await atStep(40);
      const over = await run("return document.documentElement.scrollWidth - document.documentElement.clientWidth");
      expect(over <= 0, `${over} px too wide`);
      await shoot(`whole-${width}`, true);
      await run(readFileSync(join(modules, "axe-core/axe.min.js"), "utf8") + "; window.axe = axe;");
      const { violations } = await browser.callLater("axe.run(document, {resultTypes: ['violations']})");
      expect(
        violations.length === 0,
        violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.target).join(" ")}`).join("; "),
      );
    });
  }
});
