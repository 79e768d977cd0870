// A packed motion and its series, as cases/report/html/playback.cpp lays them out.
import { unpacked } from "./data.js";

class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.at = 0;
  }
  get isAtEnd() {
    return this.at >= this.bytes.length;
  }
  u8() {
    return this.view.getUint8(this.at++);
  }
  u32() {
    return this.view.getUint32((this.at += 4) - 4, true);
  }
  f32() {
    return this.view.getFloat32((this.at += 4) - 4, true);
  }
  f64() {
    return this.view.getFloat64((this.at += 8) - 8, true);
  }
  // Low bytes of all differences, then high ones.
  differences(count) {
    const values = new Uint16Array(count);
    let sum = 0;
    for (let i = 0; i < count; ++i) {
      sum = (sum + this.bytes[this.at + i] + (this.bytes[this.at + count + i] << 8)) & 0xffff;
      values[i] = sum;
    }
    this.at += 2 * count;
    return values;
  }
  samples() {
    const count = this.u32(),
      low = this.differences(count),
      high = this.differences(count);
    return Float64Array.from(low, (value, i) => value + 65536 * high[i]);
  }
}

const halves = new Uint32Array(1),
  whole = new Float32Array(halves.buffer);
function fromHalf(bits) {
  halves[0] = bits << 16;
  return whole[0];
}

// The bodies' poses at some instants; straight lines between them.
class Motion {
  constructor(reader, bodies, timeOf) {
    const samples = reader.samples(),
      count = samples.length;
    this.times = Float64Array.from(samples, timeOf);
    this.bodies = bodies;
    if (!count) return;
    const low = [reader.f32(), reader.f32(), reader.f32()],
      extent = [reader.f32(), reader.f32(), reader.f32()];
    const packed = reader.differences(6 * bodies * count);
    (this.low = low), (this.extent = extent);
    this.values = new Float32Array(7 * bodies * count); // key, body, then x y z w x y z
    for (let channel = 0; channel < 6; ++channel) {
      for (let body = 0; body < bodies; ++body) {
        for (let key = 0; key < count; ++key) {
          const share = packed[(channel * bodies + body) * count + key] / 65535;
          const slot = 7 * (key * bodies + body);
          if (channel < 3) this.values[slot + channel] = low[channel] + share * extent[channel];
          else this.values[slot + channel + 1] = 2 * share - 1;
        }
      }
    }
    for (let slot = 0; slot < this.values.length; slot += 7) {
      const x = this.values[slot + 4],
        y = this.values[slot + 5],
        z = this.values[slot + 6];
      this.values[slot + 3] = Math.sqrt(Math.max(0, 1 - x * x - y * y - z * z));
    }
  }

  get start() {
    return this.times[0];
  }
  get end() {
    return this.times.at(-1);
  }

  // The last key at or before t.
  keyAt(t) {
    let from = 0,
      to = this.times.length - 1;
    while (from < to) {
      const middle = (from + to + 1) >> 1;
      if (this.times[middle] <= t) from = middle;
      else to = middle - 1;
    }
    return from;
  }

  // Fills `out` with seven numbers a body.
  posesAt(t, out) {
    const n = this.bodies,
      key = this.keyAt(t),
      next = Math.min(key + 1, this.times.length - 1);
    const span = this.times[next] - this.times[key];
    const share = span > 0 ? Math.min(1, Math.max(0, (t - this.times[key]) / span)) : 0;
    const v = this.values;
    for (let body = 0; body < n; ++body) {
      const a = 7 * (key * n + body),
        b = 7 * (next * n + body),
        o = 7 * body;
      for (let k = 0; k < 3; ++k) out[o + k] = v[a + k] + share * (v[b + k] - v[a + k]);
      let dot = 0,
        norm = 0;
      for (let k = 3; k < 7; ++k) dot += v[a + k] * v[b + k];
      const sign = dot < 0 ? -1 : 1;
      for (let k = 3; k < 7; ++k) {
        out[o + k] = (1 - share) * v[a + k] + share * sign * v[b + k];
        norm += out[o + k] ** 2;
      }
      norm = Math.sqrt(norm) || 1;
      for (let k = 3; k < 7; ++k) out[o + k] /= norm;
    }
    return out;
  }
}

// Each pair's contact force at the instants of the series (force_playback.h); none in results of older versions.
function readForces(reader, times) {
  if (reader.isAtEnd) return null;
  const pairs = Array.from({ length: reader.u32() }, () => [reader.u32(), reader.u32()]);
  if (!pairs.length) return null;
  const low = [reader.f32(), reader.f32(), reader.f32()],
    extent = [reader.f32(), reader.f32(), reader.f32()],
    count = times.length;
  const packed = reader.differences(9 * pairs.length * count);
  const vectorsOf = (pair, channel, read) =>
    Array.from({ length: count }, (_, n) =>
      [0, 1, 2].map((axis) => read(packed[((pair * 9 + channel + axis) * count) + n], axis)),
    );
  return pairs.map(([a, b], pair) => {
    const forces = vectorsOf(pair, 3, fromHalf);
    return {
      a,
      b,
      times,
      points: vectorsOf(pair, 0, (bits, axis) => low[axis] + (bits / 65535) * extent[axis]),
      forces,
      normals: vectorsOf(pair, 6, (bits) => (bits - 32768) / 32767),
      sizes: forces.map((force) => Math.hypot(...force)),
    };
  });
}

export async function loadPlayback(text, courseNames) {
  if (!text) return null;
  const reader = new Reader(await unpacked(text));
  const isLikeTruth = reader.u8() === 1,
    interval = reader.f64(),
    last = reader.f64(),
    bodies = reader.u32();
  const timeOf = (sample) => Math.min(sample * interval, last);
  const motion = new Motion(reader, bodies, timeOf);
  const points = Float64Array.from(reader.samples(), timeOf),
    count = points.length;
  const names = Array.from({ length: reader.u8() }, () => courseNames[reader.u8()]);
  const packed = reader.differences(names.length * count);
  const series = {};
  names.forEach((name, i) => {
    const values = Array.from({ length: count }, (_, k) => fromHalf(packed[i * count + k]));
    let length = count;
    while (length > 0 && Number.isNaN(values[length - 1])) --length;
    series[name] = { times: points.subarray(0, length), values: values.slice(0, length) };
  });
  const forces = readForces(reader, points);
  return { isLikeTruth, motion: motion.times.length ? motion : null, series, forces, last, bodies };
}

// Of a case with trials each has its own motion.
const ofTrial = (motion, trial) => (Array.isArray(motion) ? motion[trial] : motion);

// All of one case at one step, of its trial with that number: the truth and each engine that ran.
export async function loadCase(results, one, dtText, trial = 0) {
  const truth = await loadPlayback(ofTrial(one.truthPlayback, trial), results.series);
  const runs = new Map();
  for (const cell of one.cells) {
    const packed = ofTrial(cell.playback, trial);
    if (cell.dt !== dtText || !packed) continue;
    const run = await loadPlayback(packed, results.series);
    if (run.isLikeTruth) run.motion = truth?.motion ?? null;
    runs.set(cell.engine, run);
  }
  return { dt: dtText, trial, truth, runs };
}

export function valueAt(course, t) {
  const { times, values } = course;
  if (!times.length || t < times[0] || t > times[times.length - 1] + 1e-9) return null;
  let from = 0,
    to = times.length - 1;
  while (to - from > 1) {
    const middle = (from + to) >> 1;
    if (times[middle] <= t) from = middle;
    else to = middle;
  }
  const span = times[to] - times[from],
    share = span > 0 ? (t - times[from]) / span : 0;
  return values[from] + Math.min(1, Math.max(0, share)) * (values[to] - values[from]);
}
