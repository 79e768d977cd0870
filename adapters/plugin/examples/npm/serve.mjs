// Shared code of this folder's engines: the protocol's loop, and helpers for conversions. An engine is
// { info, load(scene, settings) }, and a world that it loads { step(dt, wrenches), rows(), settings, free() }. step() may
// return a text: why the step is less accurate than the method promises. A world with contacts() returns the contact forces of its last
// step, one with reactions() the loads of its joints. One with save() returns all that its next steps depend on, as bytes,
// and restore(bytes) goes back to it.
import { readSync, writeSync } from "node:fs";

// What an engine or its runtime prints must not get among the answers. Import this before the engine.
for (const name of ["log", "info", "debug"]) console[name] = console.error;

export class Unsupported extends Error {}
export class Diverged extends Error {}

// The thirteen columns of all bodies, one behind the other: all px, then all py, and so on.
function columnsOf(rows) {
  const columns = new Float64Array(13 * rows.length);
  rows.forEach((row, i) => row.forEach((number, c) => (columns[c * rows.length + i] = number)));
  return columns;
}

const diverged = (time) => ({ ok: false, status: "diverged", why: "a number is not finite", time });

const calls = {
  load({ engine, worlds }, { world, scene, settings, ...beside }) {
    worlds.set(world, { time: 0, of: engine.load(scene, settings, beside) });
    return { ok: true, settings: worlds.get(world).of.settings };
  },
  step({ worlds }, { world, dt, wrenches }) {
    const warning = worlds.get(world).of.step(dt, wrenches);
    worlds.get(world).time += dt;
    return warning ? { ok: true, warning } : { ok: true };
  },
  read({ engine, worlds }, { world }) {
    const { time, of } = worlds.get(world), bodies = of.rows(), columns = columnsOf(bodies);
    if (!columns.every(Number.isFinite)) return diverged(time);
    return engine.info.columns ? { ok: true, time, raw: [columns] } : { ok: true, time, bodies };
  },
  contacts({ worlds }, { world }) {
    return { ok: true, contacts: worlds.get(world).of.contacts() };
  },
  reactions({ worlds }, { world }) {
    return { ok: true, reactions: worlds.get(world).of.reactions() };
  },
  save({ worlds }, { world }) {
    const { time, of } = worlds.get(world);
    return { ok: true, snapshot: JSON.stringify({ time, bytes: Buffer.from(of.save()).toString("base64") }) };
  },
  restore({ worlds }, { world, snapshot }) {
    const { time, bytes } = JSON.parse(snapshot), one = worlds.get(world);
    one.of.restore(new Uint8Array(Buffer.from(bytes, "base64"))), (one.time = time);
    return { ok: true };
  },
  run(state, { world, dt, count, every }) {
    const samples = [], all = [];
    let told;
    for (let n = 1; n <= count; ++n) {
      const { warning } = calls.step(state, { world, dt });
      told ??= warning;
      if (n % every !== 0 && n !== count) continue;
      const { ok, time, bodies, raw = [] } = calls.read(state, { world });
      if (!ok) return diverged(time);
      samples.push({ time, bodies }), all.push(...raw);
    }
    return { ok: true, samples, raw: all, warning: told };
  },
  unload({ worlds }, { world }) {
    worlds.get(world).of.free?.(), worlds.delete(world);
    return { ok: true };
  },
};

function answer(state, line) {
  try {
    const asked = JSON.parse(line);
    if (asked.call === "info") return { ok: true, ...state.engine.info };
    return calls[asked.call]?.(state, asked) ?? { ok: false, status: "unsupported", why: `no call ${asked.call}` };
  } catch (error) {
    const status = error instanceof Unsupported ? "unsupported" : error instanceof Diverged ? "diverged" : "failed";
    return { ok: false, status, why: String(error.message ?? error) || "an error" };
  }
}

// A page has no pipes: there the engine stands in its host's own worker, which asks line by line (cases/laboratory/page). A
// host that measures time calls the engine itself (bench/wasm).
// RIGOR_ENGINE_NAME gives an engine another name, so that two versions of it may take part in one run.
export function serve(engine) {
  engine.info.name = globalThis.process?.env?.RIGOR_ENGINE_NAME ?? engine.info.name;
  if (globalThis.rigorHost) {
    const state = { engine, worlds: new Map() };
    const told = (line) => {
      const { raw = [], ...json } = answer(state, line);
      return (globalThis.rigorRaw = raw), JSON.stringify(json);
    };
    return globalThis.rigorHost(told, engine);
  }
  const state = { engine, worlds: new Map() }, chunk = Buffer.alloc(1 << 16);
  let text = Buffer.alloc(0);
  for (let size; (size = readSync(0, chunk)) > 0; ) {
    text = Buffer.concat([text, chunk.subarray(0, size)]);
    for (let end; (end = text.indexOf(10)) >= 0; text = text.subarray(end + 1)) {
      const { raw = [], ...json } = answer(state, text.subarray(0, end));
      for (const part of [Buffer.from(JSON.stringify(json) + "\n"), ...raw.map(({ buffer }) => Buffer.from(buffer))])
        for (let at = 0; at < part.length; ) at += writeSync(1, part, at);
    }
  }
  process.exit(0); // a runtime's own threads and timers do not keep it
}

// Converts [xx, yy, zz, xy, xz, yz] to moments and the quaternion (w, x, y, z) of the principal frame, by Jacobi's
// rotations.
export function principal([xx, yy, zz, xy, xz, yz]) {
  const a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
  let q = [1, 0, 0, 0];
  for (let sweep = 0; sweep < 30; ++sweep) {
    for (const [i, j, k] of [[0, 1, 2], [1, 2, 0], [2, 0, 1]]) {
      if (a[i][j] === 0) continue;
      const sign = a[i][i] < a[j][j] ? -1 : 1; // by at most an eighth of a turn, or it need not converge
      const angle = 0.5 * Math.atan2(2 * sign * a[i][j], sign * (a[i][i] - a[j][j])), c = Math.cos(angle), s = Math.sin(angle);
      const axis = [0, 0, 0];
      axis[k] = Math.sin(angle / 2);
      q = times(q, [Math.cos(angle / 2), ...axis]);
      const [ii, jj, ij, ik, jk] = [a[i][i], a[j][j], a[i][j], a[i][k], a[j][k]];
      a[i][i] = c * c * ii + 2 * s * c * ij + s * s * jj;
      a[j][j] = s * s * ii - 2 * s * c * ij + c * c * jj;
      a[i][j] = a[j][i] = 0;
      a[i][k] = a[k][i] = c * ik + s * jk;
      a[j][k] = a[k][j] = c * jk - s * ik;
    }
  }
  return { moments: [a[0][0], a[1][1], a[2][2]], frame: q };
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
export const times = ([a, ...u], [b, ...v]) => [a * b - dot(u, v), ...v.map((x, i) => a * x + b * u[i] + cross(u, v)[i])];
export const rotate = (q, v) => times(times(q, [0, ...v]), back(q)).slice(1);
export const back = ([w, x, y, z]) => [w, -x, -y, -z];

// The torque -w x (I w) in W, for an engine without the gyroscopic term. q is the pose of the principal frame.
export function gyroscopicTorque(q, moments, w) {
  const spin = rotate(back(q), w);
  return rotate(q, cross(spin.map((part, i) => moments[i] * part), spin));
}

// A body's pose at t = 0; of a plane, and of the world, that of W.
export function pose(scene, name) {
  const body = scene.body.find((one) => one.name === name);
  return { x: body?.position ?? [0, 0, 0], q: body?.orientation_wxyz ?? [1, 0, 0, 0] };
}
// A point and a direction of W in a body's frame at t = 0.
export const pointIn = ({ x, q }, p) => rotate(back(q), add(p, x, -1));
export const directionIn = ({ q }, v) => rotate(back(q), v);

// The one law of all pairs that can touch, for an engine whose materials are a body's and not a pair's.
export function oneLaw(scene) {
  const touching = scene.body.filter(({ collides }) => collides), moving = touching.filter(({ fixed }) => !fixed);
  const is = (bodies, name) => bodies.some((body) => body.name === name);
  const rows = (scene.contact ?? []).filter(({ a, b }) => is(touching, a) && is(touching, b) && (is(moving, a) || is(moving, b)));
  const pairs = (moving.length * (moving.length - 1)) / 2 + moving.length * (touching.length - moving.length);
  const laws = rows.length > 0 && rows.length === pairs ? rows : [...rows, scene.contact_default];
  const { restitution, friction } = laws[0];
  if (laws.some((law) => law.restitution !== restitution || law.friction !== friction || law.static_friction !== laws[0].static_friction)) throw new Unsupported("pairs of bodies have laws of their own");
  const finite = friction === "infinite" ? 1e6 : friction;
  return { restitution, friction: finite, staticFriction: laws[0].static_friction ?? finite };
}
