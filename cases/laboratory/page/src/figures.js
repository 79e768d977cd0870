// The figures that lessons state, from the runs as they are now. "…" stands for what is not known yet.
import { digits, isNumber, percent, quantity } from "../../../report/html/page/src/format.js";

const ofScene = {
  dt: (bench) => `${bench.dtText} s`,
  time: (bench) => `${bench.time.toFixed(2)} s`,
  steps: (bench) => String(bench.done),
  omega: (bench) => shown(bench.words?.mode?.frequency, (x) => quantity(x, "rad/s", 3)),
  omega_dt: (bench) => shown(omegaDt(bench), digits),
  // Of explicit Euler on a linear oscillator.
  predicted_growth: (bench) => shown(omegaDt(bench), (x) => digits(1 + x * x)),
  largest_step: (bench) => shown(bench.words?.mode?.largest_step, (x) => `${digits(x)} s = 1/${digits(1 / x)} s`),
  gravity_dt: (bench) => shown(0.5 * Math.hypot(...bench.facts.scene.gravity) * bench.dt, (x) => quantity(x, "m")),
  // Of a constant spin, by one step of the matrix.
  predicted_stretch: (bench) => shown(spinDt(bench), (x) => digits(Math.sqrt(1 + x * x), 5)),
  spin_dt: (bench) => shown(spinDt(bench), digits),
};

const ofRun = {
  growth: (bench, run) => shown(bench.words?.mode?.growth?.[run.name], digits),
  energy: (bench, run) => shown(energyShare(bench, run), percent),
  error: (bench, run) => shown(bench.reading(run)?.position, (x) => quantity(x, "m")),
  worst: (bench, run) => shown(metric(run, "position_error"), (x) => quantity(x, "m")),
  turn: (bench, run) => shown(bench.reading(run)?.orientation, (x) => quantity(x, "rad")),
  orthonormality: (bench, run) => shown(bench.reading(run)?.orthonormality, digits),
  drift: (bench, run) => shown(metric(run, "energy_drift_synchronised"), percent),
  gap: (bench, run) => shown(metric(run, "joint_gap"), (x) => quantity(x, "m")),
  height: (bench, run) => shown(run.poses?.[1], (x) => quantity(x, "m", 3)),
  blown_up: (bench, run) =>
    run.cell?.verdict?.word === "blown up" ? `blown up at ${run.cell.verdict.time.toFixed(2)} s` : "still bounded",
};

const shown = (value, write) => (isNumber(value) ? write(value) : "…");
const omegaDt = (bench) => (bench.words?.mode ? bench.words.mode.frequency * bench.dt : NaN);
const spinDt = (bench) => bench.facts.spin * bench.dt;

function energyShare(bench, run) {
  const first = bench.reading(run, 0),
    now = bench.reading(run);
  return first && now && bench.truth?.kinetic > 0 ? (now.energy - first.energy) / bench.truth.kinetic : NaN;
}

function metric(run, name) {
  const found = run.cell?.metrics?.[name];
  return found ? Number(found.value ?? NaN) : NaN;
}

export function figure(bench, name, run) {
  if (!bench.facts) return "…";
  if (run === null) return ofScene[name]?.(bench) ?? `{${name}}`;
  const row = bench.runs[run];
  return row ? (ofRun[name]?.(bench, row) ?? `{${name}}`) : "…";
}
