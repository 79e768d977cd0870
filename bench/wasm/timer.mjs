// One engine in a process of its own: times steps when its parent asks. The engine's plug-in is as it is; serve.mjs hands
// it over to rigorHost in place of the protocol's loop.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [file, scenes] = process.argv.slice(2);
const all = JSON.parse(readFileSync(scenes, "utf8"));
const kLeast = 0.05; // s of CPU time that one answer measures

let engine;
globalThis.rigorHost = (_, handed) => (engine = handed);
await import(pathToFileURL(file));

// CPU time of this process: its thread, and the engine's if it has more.
const seconds = () => {
  const { user, system } = process.cpuUsage();
  return 1e-6 * (user + system);
};

// The same interval of motion, from a fresh world each time unless the motion never ends. Reading the state is not
// timed, because each binding has its own way.
function timed({ scene: index, method, track, options }, least) {
  const { scene, dt, steps, count, goes_on } = all[index], load = () => engine.load(scene, { method, track, options }, { reports: false });
  let world = load(), spent = 0, taken = 0;
  while (spent < least) {
    const start = seconds();
    for (let n = 0; n < steps; ++n) world.step(dt);
    spent += seconds() - start, taken += steps;
    if (!world.rows().flat().every(Number.isFinite)) throw new Error("a number is not finite");
    if (!goes_on && spent < least) world.free?.(), (world = load());
  }
  world.free?.();
  return (1e9 * spent) / (taken * count);
}

process.on("message", (asked) => {
  try {
    // The compilers of the virtual machine need some calls until the code is as fast as it gets.
    if (asked.warm_up) timed(asked, asked.warm_up);
    process.send({ ns: timed(asked, kLeast) });
  } catch (error) {
    process.send({ why: String(error.message ?? error) });
  }
});
process.send({ ready: true });
