// Measures how often the laboratory draws 200 boxes in three engines side by side, in a headless Chromium:
//   node frame_rate.mjs PAGE.html SHOTS-FOLDER FOLDER-OF-node_modules [RUNS [PROFILE.txt]]
// Prints frames per second and simulated seconds per second. With PROFILE, also where the page's own thread spends its
// time.
import { writeFileSync } from "node:fs";
import { setTimeout as sleep } from "node:timers/promises";
import { browser, choose, click, finish, open, run, shoot, until } from "./page_driver.mjs";

const kSeconds = 6;
const [runs = "core:semi-implicit-euler,contact=impulse~bullet~ode", profile] = process.argv.slice(5);
const box = (i) => {
  const [x, y, z] = [i % 10, Math.floor(i / 10) % 10, Math.floor(i / 100)];
  return `{ name = "b${i}", mass = 1, position = [${0.5 * x}, ${0.5 * y}, ${0.5 + 0.6 * z}], shape = { type = "box", size = [0.3, 0.3, 0.3] } }`;
};
const scene = `title = "200 boxes"
source = "made to measure frames"
[scene]
gravity = [0, 0, -9.81]
contact_default = { restitution = 0, friction = 0.5 }
body = [
${Array.from({ length: 200 }, (_, i) => box(i)).join(",\n")},
{ name = "ground", shape = { type = "plane", normal = [0, 0, 1], offset = 0 } }]
[run]
duration = 30
dt = ["1/60"]
[truth]
kind = "none"
`;

const selfTimes = ({ nodes, samples, timeDeltas }) => {
  const names = new Map(nodes.map(({ id, callFrame }) => [id, `${callFrame.functionName || "(nameless)"}:${callFrame.lineNumber}:${callFrame.columnNumber}`]));
  const sums = new Map();
  samples.forEach((id, k) => sums.set(names.get(id), (sums.get(names.get(id)) ?? 0) + timeDeltas[k] / 1e3));
  return [...sums].sort((a, b) => b[1] - a[1]);
};

await finish(async () => {
  await open(`#/springs/fixed-spring?runs=${runs}&layout=side&dt=1/60`);
  await choose({ "boxes.toml": scene });
  await until("document.querySelector('h1').textContent === '200 boxes'", "the boxes", 60);
  await until("!document.querySelector('.now').textContent.includes('–') || true", "the runs", 60);
  await sleep(3000);
  const now = () => run("return { frames: Number(document.querySelector('canvas').dataset.frames), step: Number(document.querySelector('main').dataset.step), at: performance.now() }");
  await click("#play");
  await sleep(1000);
  if (profile) await browser.devtools("Profiler.enable", {}), await browser.devtools("Profiler.start", {});
  const before = await now();
  await sleep(1000 * kSeconds);
  const after = await now(), seconds = (after.at - before.at) / 1000;
  if (profile) {
    const { profile: found } = await browser.devtools("Profiler.stop", {});
    writeFileSync(profile, selfTimes(found).slice(0, 40).map(([name, ms]) => `${(ms / seconds).toFixed(1)} ms/s  ${name}`).join("\n") + "\n");
  }
  await shoot("frame-rate");
  const kind = await run("return document.querySelector('canvas').dataset.kind");
  console.log(`${((after.frames - before.frames) / seconds).toFixed(1)} frames/s by ${kind}; ${((after.step - before.step) / 60 / seconds).toFixed(2)} simulated seconds per second`);
});
