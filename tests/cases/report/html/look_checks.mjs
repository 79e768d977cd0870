// How the page looks in light and dark, on a phone, in print and without WebGL; screenshots are kept.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { Browser } from "./browser.mjs";
import {
  boxOf,
  check,
  clock,
  colours,
  equal,
  expect,
  loaded,
  open,
  quiet,
  shoot,
  shots,
  spring,
} from "./report_page.mjs";

const modules = process.env.RIGOR_PAGE_MODULES;

export async function looks() {
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
        const pages = Buffer.from(data, "base64").toString("latin1").match(/\/Type\s*\/Page\b/g)?.length;
        equal(pages, 2, "printed pages");
        equal(await browser.run("return document.querySelectorAll('.frontier svg, .cards .card, .matrix tr').length > 3"), true, "picture, cards and matrix");
      });
    }
    await check(`${name}: axe-core finds nothing`, async () => {
      await browser.run(readFileSync(join(modules, "axe-core/axe.min.js"), "utf8") + "; window.axe = axe;");
      const found = await browser.callLater("axe.run(document, {resultTypes: ['violations']})");
      const told = found.violations.map((v) => `${v.id}: ${v.help}\n        ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 120)).join("\n        ")}`);
      expect(!told.length, told.join("\n      "));
    });
    await browser.close();
  }
}

export async function withoutWebgl() {
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
