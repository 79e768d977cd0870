// The smallest engine for Rigor in JavaScript, to copy: free bodies by semi-implicit Euler, in Node alone.
//
//   rigor conform --plugin "node toy.mjs"
//
// The same steps as toy.py; it answers with raw doubles ("columns": "f64le"), for which 1000 bodies are no more work
// than ten.
import { readSync, writeSync } from "node:fs";

const INFO = {
  ok: true, name: "toy-js", version: "1", precision: "double", features: ["wrench", "fixed-body"], calls: ["run"], columns: "f64le",
  methods: [{ name: "euler", summary: "semi-implicit Euler, angular momentum kept in the world frame", order: 1, leapfrog_stagger: 0.5 }],
};

const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const apply = (m, v) => m.map((row) => dot(row, v));
const times = ([a, ...u], [b, ...v]) => [a * b - dot(u, v), ...add(add(v.map((x) => a * x), u, b), cross(u, v))];
const conjugate = ([w, x, y, z]) => [w, -x, -y, -z];
const rotate = (q, v) => times(times(q, [0, ...v]), conjugate(q)).slice(1);
const inWorld = (m, q, v) => rotate(q, apply(m, rotate(conjugate(q), v)));
const exp = (v) => {
  const angle = Math.hypot(...v), s = angle > 1e-8 ? Math.sin(angle / 2) / angle : 0.5 - (angle * angle) / 48;
  return [Math.cos(angle / 2), ...v.map((x) => s * x)];
};
const scaled = (s, v) => v.map((x) => s * x);
const inverse = (m) => {
  const c = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])], det = dot(m[0], c[0]);
  return [0, 1, 2].map((i) => [0, 1, 2].map((j) => c[j][i] / det));
};

function bodyOf({ mass, inertia: [xx, yy, zz, xy, xz, yz], fixed, position, orientation_wxyz, velocity, angular_velocity }) {
  const inertia = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
  return {
    mass, fixed, inertia, inverse: fixed ? null : inverse(inertia),
    x: position ?? [0, 0, 0], q: orientation_wxyz ?? [1, 0, 0, 0], v: velocity, w: angular_velocity,
  };
}

function stepBody(body, gravity, dt, wrench) {
  body.v = add(body.v, add(gravity, wrench.slice(0, 3), 1 / body.mass), dt);
  body.x = add(body.x, body.v, dt);
  const momentum = add(inWorld(body.inertia, body.q, body.w), wrench.slice(3), dt);
  const first = inWorld(body.inverse, body.q, momentum);
  const middle = inWorld(body.inverse, times(exp(scaled(dt / 2, first)), body.q), momentum);
  const q = times(exp(scaled(dt, middle)), body.q);
  body.q = scaled(1 / Math.hypot(...q), q);
  body.w = inWorld(body.inverse, body.q, momentum);
}

function step(world, dt, wrenches) {
  world.bodies.forEach((body, i) => body.fixed || stepBody(body, world.gravity, dt, wrenches?.[i] ?? [0, 0, 0, 0, 0, 0]));
  world.time += dt;
}

// The thirteen columns, one behind the other: all px, then all py, ...
function columnsOf(world) {
  const columns = new Float64Array(13 * world.bodies.length);
  world.bodies.forEach(({ x, q, v, w }, i) => {
    [...x, ...q, ...v, ...w].forEach((number, c) => (columns[c * world.bodies.length + i] = number));
  });
  return columns;
}

const diverged = (time) => ({ ok: false, status: "diverged", why: "a number is not finite", time });
const areFinite = (columns) => columns.every(Number.isFinite);

// The answer, and the raw doubles that follow its line.
const calls = {
  info: () => [INFO],
  load(worlds, { world, scene }) {
    worlds.set(world, { gravity: scene.gravity, bodies: scene.body.map(bodyOf), time: 0 });
    return [{ ok: true, settings: { gyroscopic: "on, by the angular momentum" } }];
  },
  step(worlds, { world, dt, wrenches }) {
    step(worlds.get(world), dt, wrenches);
    return [{ ok: true }];
  },
  read(worlds, { world }) {
    const { time } = worlds.get(world), columns = columnsOf(worlds.get(world));
    return areFinite(columns) ? [{ ok: true, time }, columns] : [diverged(time)];
  },
  run(worlds, { world, dt, count, every }) {
    const samples = [], raw = [];
    for (let n = 1; n <= count; ++n) {
      step(worlds.get(world), dt);
      if (n % every !== 0 && n !== count) continue;
      samples.push({ time: worlds.get(world).time }), raw.push(columnsOf(worlds.get(world)));
      if (!areFinite(raw.at(-1))) return [diverged(samples.at(-1).time)];
    }
    return [{ ok: true, samples }, ...raw];
  },
  unload: (worlds, { world }) => [{ ok: worlds.delete(world), status: "failed", why: "no such world" }],
};

function write(bytes) {
  for (let at = 0; at < bytes.length; ) at += writeSync(1, bytes, at);
}

const worlds = new Map(), chunk = Buffer.alloc(1 << 16);
let text = Buffer.alloc(0);
for (let size; (size = readSync(0, chunk)) > 0; ) {
  text = Buffer.concat([text, chunk.subarray(0, size)]);
  for (let end; (end = text.indexOf(10)) >= 0; text = text.subarray(end + 1)) {
    let answer;
    try {
      const asked = JSON.parse(text.subarray(0, end));
      answer = calls[asked.call]?.(worlds, asked) ?? [{ ok: false, status: "unsupported", why: `no call ${asked.call}` }];
    } catch (error) {
      answer = [{ ok: false, status: "failed", why: String(error) }];
    }
    write(Buffer.from(JSON.stringify(answer[0]) + "\n"));
    answer.slice(1).forEach((columns) => write(Buffer.from(columns.buffer)));
  }
}
