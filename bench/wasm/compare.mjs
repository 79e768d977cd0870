// Times the core's WebAssembly build against engines of the npm registry and prints one table of ratios:
//   node compare.mjs SCENES.json ENGINES CORE-WITH-SIMD CORE-WITHOUT [--rounds N] [--filter TEXT]
// Each engine has a Node process of its own. In each round every run of a scene is timed once, one after the other.
import { fork } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { cpus } from "node:os";

const [scenesFile, engines, simd, plain, ...rest] = process.argv.slice(2);
const option = (name, otherwise) => (rest.includes(name) ? rest[rest.indexOf(name) + 1] : otherwise);
const rounds = Number(option("--rounds", 5)), filter = option("--filter", "");
const scenes = JSON.parse(readFileSync(scenesFile, "utf8"));

const kFiles = { "mujoco-js": "mujoco", "rapier-simd": "rapier-simd/rapier" };
const kCores = { "core-wasm": simd, "core-wasm-plain": plain };
const kWarmUp = 0.4, kLong = 8; // s; a run that takes longer is timed once

function started(engine) {
  const file = join(engines, `${kCores[engine] ? "core" : kFiles[engine] ?? engine}.mjs`);
  const child = fork(join(engines, "timer.mjs"), [file, scenesFile], {
    env: { ...process.env, RIGOR_CORE_WASM: kCores[engine] ?? "" },
    stdio: ["ignore", "ignore", "ignore", "ipc"],
  });
  const answer = () => new Promise((done) => {
    child.once("message", done);
    child.once("exit", (code) => done({ why: `the process ended with exit code ${code}` }));
  });
  const ready = answer();
  return {
    async ask(message) {
      const up = await ready;
      if (up.why) return up;
      child.removeAllListeners("exit");
      const told = answer();
      if (child.connected) child.send(message);
      return told;
    },
    end: () => child.kill(),
  };
}

const median = (values) => {
  const sorted = [...values].sort((a, b) => a - b), half = sorted.length >> 1;
  return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
};
const digits = (x) => (x >= 999.5 ? x.toFixed(0) : String(Number(x.toPrecision(3))));
const time = (ns) => (ns < 999.5 ? `${digits(ns)} ns` : ns < 999.5e3 ? `${digits(ns / 1e3)} us` : `${digits(ns / 1e6)} ms`);
const kWords = { error_m_rad: "error [m, rad]", penetration_m: "deepest overlap [m]", joint_gap_m: "widest gap [m]" };

// Rounds of all runs of a scene, interleaved.
async function timesOf(scene, index, processes) {
  const runs = scene.runs.filter(({ why }) => !why).map((run) => ({ ...run, ns: [] }));
  for (let round = 0; round < rounds; ++round) {
    for (const run of runs) {
      if (run.failed || run.is_long) continue;
      processes[run.engine] ??= started(run.engine);
      const { method, track, options } = run, begun = Date.now();
      const told = await processes[run.engine].ask({ scene: index, method, track, options, warm_up: round === 0 ? kWarmUp : 0 });
      if (told.why) run.failed = told.why;
      else run.ns.push(told.ns), (run.is_long = Date.now() - begun > 1e3 * (kLong + kWarmUp));
      process.stderr.write(`${scene.name} ${run.run}: ${told.why ?? time(told.ns)}\n`);
    }
  }
  return runs;
}

function ratiosOf(core, other) {
  const each = other.ns.map((ns, k) => ns / (core.ns[k] ?? median(core.ns)));
  return { value: median(other.ns) / median(core.ns), low: Math.min(...each), high: Math.max(...each) };
}

function reachedBy(core, other) {
  return Object.keys(kWords).flatMap((key) => {
    const [ours, theirs] = [core.reached?.[key], other.reached?.[key]];
    return ours === undefined || theirs === undefined ? [] : [`${kWords[key]} ${Number(ours).toExponential(1)} / ${theirs === null ? "infinite" : theirs.toExponential(1)}`];
  }).join(", ");
}

const isCore = ({ engine }) => engine in kCores;
// A goal asks for no deeper overlap and no wider gap. The error of a trajectory is shown beside it.
const isAsGood = (core, other) => ["penetration_m", "joint_gap_m"].every((key) => core.reached?.[key] === undefined || other.reached?.[key] == null || core.reached[key] <= other.reached[key]);

function rowsOf({ name, count, goal, runs: given }, timed) {
  const title = `${name}, N = ${count}`, rows = [], others = timed.filter((run) => !isCore(run) && run.ns.length);
  const [core] = timed.filter((run) => run.run === "core-wasm" && run.ns.length);
  if (!core) return [`${title}: the core was not timed`];
  const row = (what, a, b, asked = 0) => {
    const { value, low, high } = ratiosOf(a, b), met = value >= asked && isAsGood(a, b) ? "yes" : "no ";
    const cells = [time(median(a.ns)).padStart(9), time(median(b.ns)).padStart(9), `${digits(value)} x`.padStart(9), `${digits(low)} x .. ${digits(high)} x`.padEnd(19)];
    rows.push(`${what.padEnd(68)} ${cells.join(" ")} ${(asked ? `>= ${asked} x` : "").padStart(8)}  ${asked ? met : "   "}  ${reachedBy(a, b)}`);
  };
  const said = ({ run, precision, version }) => `${run} ${version} (${precision})`;
  for (const other of others) row(`${title} against ${said(other)}`, core, other);
  if (goal && others.length) {
    const fastest = others.reduce((a, b) => (median(a.ns) <= median(b.ns) ? a : b));
    for (const one of timed.filter((run) => run.engine === "core-wasm" && run.ns.length))
      row(`${title}${one.run.slice("core-wasm".length).replace(",", ", ")} against the fastest, ${fastest.run}`, one, fastest, goal);
  }
  for (const other of timed.filter((run) => run.run === "core-wasm-plain" && run.ns.length)) row(`${title}, with SIMD against without`, core, other);
  const inWords = (why) => why.replace(/^plug-in '.*?' says that '\w+' failed: /, "").replace(/(\s|\\x0a)+/g, " ").replace(/^'(.*?) ?'$/, "$1");
  for (const { run, why, failed } of [...given, ...timed])
    if (failed ?? why) rows.push(`${`${title} against ${run}`.padEnd(68)}  -  ${inWords(failed ?? why)}`);
  return rows;
}

const processes = {}, table = [];
for (const [index, scene] of scenes.entries()) {
  if (!scene.name.includes(filter)) continue;
  table.push(...rowsOf(scene, await timesOf(scene, index, processes)));
}
Object.values(processes).forEach((one) => one.end());
console.log(`${cpus()[0].model}, ${cpus().length} cores; Node ${process.versions.node}, V8 ${process.versions.v8}. Each step of the core is semi-implicit Euler in double precision.`);
console.log(`${"per body and step".padEnd(68)} ${"this".padStart(9)} ${"other".padStart(9)} ${"ratio".padStart(9)} ${"range".padEnd(19)} ${"goal".padStart(8)}  met, and what both reach`);
for (const row of table) console.log(row);
