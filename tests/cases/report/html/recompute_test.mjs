// Checks that the numbers of results.json, which the page shows, follow from the trajectories beside it, the scenes in
// it and the truth.
// node recompute_test.mjs RIGOR FOLDER
// RIGOR gives the truth at the instants of each trajectory; this script computes the rest.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";

const [rigor, folder] = process.argv.slice(2);
const results = JSON.parse(readFileSync(join(folder, "results.json"), "utf8"));

// Rows of states, by instant and body.
function read(csv) {
  const instants = [];
  for (const line of csv.trim().split("\n").slice(1)) {
    const [, time, name, rest] = /^([^,]*),((?:"(?:[^"]|"")*")|[^,]*),(.*)$/.exec(line);
    const v = rest.split(",").map(Number);
    if (!instants.length || instants.at(-1).text !== time) instants.push({ text: time, time: Number(time), bodies: [] });
    instants.at(-1).bodies.push({ name, p: v.slice(0, 3), q: v.slice(3, 7), v: v.slice(7, 10), w: v.slice(10, 13) });
  }
  return instants;
}

const dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);
const minus = (a, b) => a.map((x, k) => x - b[k]);
const size = (a) => Math.hypot(...a);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const turn = ([w, ...u], v) => {
  const t = cross(u, v).map((x) => 2 * x),
    again = cross(u, t);
  return v.map((x, k) => x + w * t[k] + again[k]);
};
const conjugate = ([w, ...u]) => [w, ...u.map((x) => -x)];
const times = ([a, ...u], [b, ...v]) => [a * b - dot(u, v), ...cross(u, v).map((x, k) => x + a * v[k] + b * u[k])];
const angle = (a, b) => {
  const [w, ...u] = times(conjugate(a), b);
  return 2 * Math.atan2(size(u), Math.abs(w));
};

function energy(scene, bodies) {
  const at = (name, point) => {
    const body = bodies[scene.bodies.findIndex((b) => b.name === name)];
    return body ? turn(body.q, point).map((x, k) => x + body.p[k]) : point;
  };
  let sum = 0;
  scene.bodies.forEach(({ mass, inertia: [xx, yy, zz, xy, xz, yz], fixed }, i) => {
    if (fixed) return;
    const { p, q, v, w } = bodies[i],
      [x, y, z] = turn(conjugate(q), w);
    sum += 0.5 * mass * dot(v, v) - mass * dot(scene.gravity, p);
    sum += 0.5 * (xx * x * x + yy * y * y + zz * z * z) + xy * x * y + xz * x * z + yz * y * z;
  });
  for (const s of scene.springs) {
    const stretch = size(minus(at(s.b, s.point_b), at(s.a, s.point_a))) - s.rest_length;
    sum += (0.5 * s.stiffness + ((s.quadratic_stiffness ?? 0) / 3) * Math.abs(stretch)) * stretch * stretch;
  }
  return sum;
}

let compared = 0,
  spreads = 0;
const misses = [];
// Both sum the same 17-digit numbers in another order: some roundings of the largest of them.
function compare(cell, name, found, scale) {
  const { value } = cell.metrics[name];
  ++compared;
  if (!(Math.abs(found - value) <= 1e-12 * Math.max(1, scale) + 1e-9 * value))
    misses.push(`${cell.case}, ${cell.engine}, dt = ${cell.dt}: ${name} is ${found}, results.json says ${value}`);
}

const largest = (instants, until, of) =>
  Math.max(...instants.map((now, n) => (now.time <= until * (1 + 1e-12) ? of(now, n) : 0)));

for (const one of results.cases) {
  const coarsest = one.dt.reduce((a, b) => (b.seconds > a.seconds ? b : a));
  const isKept = !one.scene.springs.some((s) => s.damping > 0) && !one.scene.forces?.length && one.truth.kind !== "none";
  for (const cell of results.cells.filter((c) => c.case === one.id && c.dt === coarsest.text)) {
    if (cell.status !== "pass") continue;
    const run = read(readFileSync(join(folder, "trajectories", cell.trajectory), "utf8"));
    const truth = read(
      execFileSync(rigor, ["truth", one.id, "--times", run.map((now) => now.text).join(",")], { encoding: "utf8" }),
    );
    const overBodies = (of) => (now, n) => Math.max(...now.bodies.map((body, i) => of(body, truth[n].bodies[i])));
    const { position_error: position, orientation_error: orientation, energy_drift: drift } = cell.metrics;
    const anisotropy = cell.metrics.friction_anisotropy;
    if (anisotropy?.value !== undefined) {
      const stop = run.findLastIndex((now) => now.time <= anisotropy.compared_until * (1 + 1e-12));
      const stopped = one.scene.bodies.flatMap(({ fixed }, i) => (fixed || size(truth[stop].bodies[i].v) ? [] : [i]));
      const ways = (instants) => stopped.map((i) => size(minus(instants[stop].bodies[i].p, instants[0].bodies[i].p)));
      const found = ways(run).filter((_, i) => ways(truth)[i] > 0),
        expected = Math.max(...ways(truth));
      compare(cell, "friction_anisotropy", (Math.max(...found) - Math.min(...found)) / expected, 10);
      ++spreads;
    }
    if (position?.value !== undefined)
      compare(
        cell,
        "position_error",
        largest(run, position.compared_until, overBodies((a, b) => size(minus(a.p, b.p)))),
        largest(run, Infinity, overBodies((a) => size(a.p))),
      );
    if (orientation?.value !== undefined)
      compare(
        cell,
        "orientation_error",
        largest(run, orientation.compared_until, overBodies((a, b) => angle(a.q, b.q))),
        10,
      );
    if (isKept && !one.scene.bodies.some((b) => b.collides && b.shape) && drift?.value !== undefined) {
      const start = energy(one.scene, run[0].bodies);
      const found = largest(run, drift.compared_until, ({ bodies }) => Math.abs(energy(one.scene, bodies) - start));
      compare(cell, "energy_drift", found / one.largest_kinetic_energy, 10 * (1 + Math.abs(start) / one.largest_kinetic_energy));
    }
  }
}
misses.forEach((text) => console.log(text));
console.log(`${compared} numbers compared, ${misses.length} differ`);
if (misses.length || compared < 20 || !spreads) process.exit(1);
