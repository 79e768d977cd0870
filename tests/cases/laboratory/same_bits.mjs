// Compares the simulators in WebAssembly with the program, state by state, by the hashes of `rigor repeat --record`.
//   node same_bits.mjs rigor_play.js SUITE RECORD.jsonl…
// Prints for each row the first step whose bits differ, and both states. The exit code is 1 if any differ.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { instanceOf } from "../../../cases/laboratory/page/src/instance.js";

const [glue, suite, ...records] = process.argv.slice(2);
const make = createRequire(import.meta.url)(resolve(glue));
const wasm = await WebAssembly.compile(readFileSync(glue.replace(/\.js$/, ".wasm")));

const rows = records.flatMap((file) => readFileSync(file, "utf8").trim().split("\n").map((line) => JSON.parse(line)));
let differing = 0;
for (const row of rows) {
  const { call } = await instanceOf(make, wasm);
  const file = { path: row.case, text: readFileSync(join(suite, `${row.case}.toml`), "utf8") };
  const steps = row.hashes.length / 16 - 1,
    answer = call({ call: "hashes", ...file, run: row.run, dt: row.dt, steps });
  if (!answer.ok) {
    console.log(`${row.case} ${row.run}: ${answer.why}`);
    ++differing;
    continue;
  }
  let step = 0;
  while (step <= steps && answer.hashes.slice(16 * step, 16 * step + 16) === row.hashes.slice(16 * step, 16 * step + 16)) ++step;
  if (step <= steps) ++differing;
  console.log(`${row.case} ${row.run} ${row.dt}: ${step > steps ? `the same bits in ${steps} steps` : `differs from step ${step} of ${steps} on`}`);
}
process.exit(differing > 0 ? 1 : 0);
