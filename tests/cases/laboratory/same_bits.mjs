// Compares the simulators in WebAssembly with the program, state by state, by the hashes of `rigor repeat --record`.
//   node same_bits.mjs rigor rigor_play.js SUITE [CASE RUN]…
// Without cases: those of the table below. Prints for each the first step whose bits differ. The exit code is 1 if a row
// is not as the table says.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { instanceOf } from "../../../cases/laboratory/page/src/instance.js";

const dt = "1/240";
const smooth = [
  "springs/fixed-spring",
  "springs/body-springs",
  "ballistic/orientation-updates",
  "tops/dzhanibekov-box",
];
const methods = [
  "adams",
  "dormand-prince",
  "explicit-euler",
  "moser-veselov",
  "rk4",
  "rkmk4",
  "semi-implicit-euler",
  "symplectic4",
  "velocity-verlet",
];
const same = [
  ...methods.flatMap((method) => smooth.map((id) => [id, `core:${method}`])),
  ...["rk4", "velocity-verlet"].flatMap((method) =>
    ["contact/collision", "joints/double-pendulum", "springs/net"].map((id) => [id, `core:${method}`]),
  ),
  ...["bullet", "ode"].flatMap((engine) =>
    ["ballistic/orientation-updates", "contact/collision", "joints/double-pendulum", "tops/dzhanibekov-box"].map((id) => [id, engine]),
  ),
  ["contact/stack-of-ten", "bullet"],
];
// Eigen sums in another order where it has vector instructions, as in the program (cases/docs/guides/laboratory.md).
const different = [
  ["ballistic/orientation-updates", "core:semi-implicit-euler,orientation=matrix-additive"],
  ["contact/stack-of-ten", "core:velocity-verlet"],
  ["contact/tumbling-box", "core:velocity-verlet"],
  ["springs/fixed-spring", "core:implicit-midpoint"],
  ["springs/fixed-spring", "bullet"],
  ["springs/fixed-spring", "ode"],
];

const [rigor, glue, suite, ...words] = process.argv.slice(2);
const make = createRequire(import.meta.url)(resolve(glue)),
  wasm = await WebAssembly.compile(readFileSync(glue.replace(/\.js$/, ".wasm"))),
  folder = mkdtempSync(join(tmpdir(), "rigor-bits-"));
process.setMaxListeners(0);

function recorded(id, run) {
  const file = join(folder, "record.jsonl");
  execFileSync(rigor, ["repeat", id, "--engine", run, "--dt", dt, "--record", file], { stdio: "ignore" });
  return JSON.parse(readFileSync(file, "utf8")).hashes;
}

// The first step whose bits differ; null if none does.
async function firstDifference(id, run) {
  const due = recorded(id, run),
    steps = due.length / 16 - 1,
    { call } = await instanceOf(make, wasm),
    answer = call({ call: "hashes", path: id, text: readFileSync(join(suite, `${id}.toml`), "utf8"), run, dt, steps });
  if (!answer.ok) throw new Error(`${id} ${run}: ${answer.why}`);
  for (let step = 0; step <= steps; ++step)
    if (answer.hashes.slice(16 * step, 16 * step + 16) !== due.slice(16 * step, 16 * step + 16)) return step;
  return null;
}

const asked = [];
for (let k = 0; k + 1 < words.length; k += 2) asked.push([words[k], words[k + 1]]);
const rows =
  asked.length > 0
    ? asked.map((row) => [...row, null])
    : [...same.map((row) => [...row, true]), ...different.map((row) => [...row, false])];
let wrong = 0;
for (const [id, run, isSame] of rows) {
  const step = await firstDifference(id, run);
  if (isSame !== null && (step === null) !== isSame) ++wrong;
  console.log(`${id} ${run}: ${step === null ? "the same bits" : `other bits from step ${step} on`}`);
}
rmSync(folder, { recursive: true });
console.log(wrong === 0 ? "all as expected" : `${wrong} rows are not as the table says`);
process.exit(wrong === 0 ? 0 : 1);
