// Tests bench/run --wasm: the core as WebAssembly, and the table that compares it.
//   node wasm_test.mjs RIGOR FOLDER-OF-bench-wasm SOURCE
import { execFileSync, spawnSync } from "node:child_process";
import { cpSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { check, expect, summed } from "../cases/report/html/checks.mjs";

const [rigor, wasm, source] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "rigor-bench-wasm-"));
const coreOf = (simd) => `env RIGOR_CORE_WASM=${wasm}/core-simd-${simd}/rigor_core.js node ${wasm}/engines/core.mjs`;

const trace = (words) => execFileSync(rigor, ["trace", ...words], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"], maxBuffer: 1 << 28 });

await check("the core conforms with vector instructions and without", () => {
  for (const simd of ["ON", "OFF"]) {
    const { stdout } = spawnSync(rigor, ["conform", "--plugin", coreOf(simd)], { encoding: "utf8" });
    expect(/core-wasm(-plain)? conforms/.test(stdout), stdout);
  }
});
await check("vector instructions give the same bits as none, and as the program's", () => {
  for (const [id, method] of [["contact/stack-of-ten", "semi-implicit-euler,contact=impulse"], ["joints/double-pendulum", "semi-implicit-euler"], ["mechanisms/ragdoll", "velocity-verlet"]]) {
    const rows = (words) => trace([id, "--dt", "1/240", "--duration", "0.5", ...words]);
    const simd = rows(["--engine", `core-wasm:${method}`, "--plugin", coreOf("ON")]);
    expect(simd.split("\n").length > 100, `${id}: too few rows`);
    expect(simd === rows(["--engine", `core-wasm-plain:${method}`, "--plugin", coreOf("OFF")]), `${id} ${method}: SIMD changes bits`);
  }
  const free = ["tops/dzhanibekov-box", "--dt", "1/240", "--duration", "0.5"];
  expect(
    trace([...free, "--engine", "core-wasm:velocity-verlet", "--plugin", coreOf("ON")]) === trace([...free, "--engine", "core:velocity-verlet"]),
    "a free body moves differently in WebAssembly",
  );
});

// Two engines that do nothing, for a while: what is measured is known to a factor.
const idle = (name, turns) => `import { serve } from "./serve.mjs";
let sum = 0;
serve({
  info: { name: "${name}" },
  load: (scene) => ({
    step() { for (let i = 0; i < ${turns}; ++i) sum += Math.sqrt(i); },
    rows: () => [[${name === "breaks" ? "NaN" : "sum"}]],
  }),
});`;
const run = (engine, reached) => ({ engine, run: engine, method: "m", track: "matched", options: {}, precision: "double", version: "1", reached });
function tableOf(runs, goal) {
  for (const [name, turns] of [["core", 20000], ["slow", 100000], ["breaks", 1000]]) writeFileSync(join(folder, `${name}.mjs`), idle(name, turns));
  for (const file of ["timer.mjs", "compare.mjs"]) cpSync(join(source, "bench/wasm", file), join(folder, file));
  cpSync(join(source, "adapters/plugin/examples/npm/serve.mjs"), join(folder, "serve.mjs"));
  const scene = { name: "made", count: 10, goal, dt: 0.01, steps: 20, goes_on: false, scene: { body: [] }, runs };
  writeFileSync(join(folder, "scenes.json"), JSON.stringify([scene]));
  return execFileSync(process.execPath, [join(folder, "compare.mjs"), join(folder, "scenes.json"), folder, "-", "-", "--rounds", "3"], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });
}
const row = (table, start) => table.split("\n").find((line) => line.startsWith(start)) ?? `no row ${start}`;

await check("a ratio is that of the times, and a goal is met if nothing is worse", () => {
  const table = tableOf([run("core-wasm", { penetration_m: 1e-3 }), run("slow", { penetration_m: 2e-3 })], 2);
  const found = row(table, "made, N = 10 against the fastest, slow"),
    ratio = Number(/ ([\d.]+) x /.exec(found)?.[1]);
  expect(ratio > 2.5 && ratio < 10, found); // 5 by the loops' lengths
  expect(/>= 2 x +yes/.test(found) && found.includes("1.0e-3 / 2.0e-3"), found);
  expect(/>= 50 x +no/.test(row(tableOf([run("core-wasm"), run("slow")], 50), "made, N = 10 against the fastest")), "a goal that is missed");
});
await check("a goal is not met by a deeper overlap", () => {
  const table = tableOf([run("core-wasm", { penetration_m: 3e-3 }), run("slow", { penetration_m: 2e-3 })], 2);
  expect(/>= 2 x +no/.test(row(table, "made, N = 10 against the fastest")), table);
});
await check("an engine that fails has its reason in its row", () => {
  const refused = { ...run("slow"), why: "it has no joints" };
  const table = tableOf([run("core-wasm"), run("breaks"), refused], 0);
  expect(row(table, "made, N = 10 against breaks").includes("a number is not finite"), table);
  expect(row(table, "made, N = 10 against slow").includes("it has no joints"), table);
});

rmSync(folder, { recursive: true });
process.exit(summed());
