// The drawing of contact forces: for each pair an arrow from where its resultant acts, and the friction cone around the
// normal. A force inside its cone holds; one on the cone slides.
import { cross, dot, moved, unit } from "./vectors.js";

const across = (v) => unit(cross(v, Math.abs(v[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));

// The friction of each pair of bodies in a scene; not a number where it is infinite.
export function frictionOf(scene) {
  const index = new Map(scene.bodies.map((b, i) => [b.name, i])),
    all = Number(scene.contact_default?.friction ?? 0),
    own = new Map();
  for (const contact of scene.contacts ?? []) {
    const [a, b] = [index.get(contact.a), index.get(contact.b)];
    own.set(`${Math.min(a, b)} ${Math.max(a, b)}`, Number(contact.friction ?? all));
  }
  return (a, b) => own.get(`${a} ${b}`) ?? all;
}

// A force that is usual in these runs: the median of the larger half. Impacts do not make resting forces invisible.
export function usualForce(runs) {
  const sizes = runs.flatMap((run) => (run.forces ?? []).flatMap((pair) => pair.sizes.filter((size) => size > 0)));
  sizes.sort((a, b) => a - b);
  return sizes.length ? sizes[Math.floor(0.75 * (sizes.length - 1))] : 0;
}

// Each pair's resultant in the last step before `time`, on the second body, or on the first if the second is fixed. Pairs
// that do not touch are left out.
export function forcesAt(pairs, time, bodies) {
  const found = [];
  for (const { a, b, times, points, forces, normals, sizes } of pairs ?? []) {
    let n = times.length - 1;
    while (n > 0 && times[n] > time + 1e-9) --n;
    if (!(sizes[n] > 0) || Math.hypot(...normals[n]) < 0.5) continue;
    const sign = bodies[b].fixed ? -1 : 1,
      on = (v) => v.map((x) => sign * x);
    found.push({ a, b, point: points[n], force: on(forces[n]), normal: on(normals[n]), size: sizes[n] });
  }
  return found;
}

// `arrows` and `cones`: segments of two points each. `metres`: the length of a newton; `most` that of any arrow.
export function forceSegments(found, friction, metres, most) {
  const arrows = [],
    cones = [];
  for (const { a, b, point, force, normal, size } of found) {
    const length = Math.min(most, metres * size),
      way = unit(force),
      tip = moved(point, way, length),
      side = across(way);
    arrows.push([point, tip]);
    for (const sign of [-1, 1]) arrows.push([tip, moved(moved(tip, way, -0.2 * length), side, sign * 0.08 * length)]);
    const mu = friction(a, b),
      height = (length * dot(force, normal)) / size;
    if (!(mu > 0) || !Number.isFinite(mu) || !(height > 0)) continue;
    const u = across(normal),
      v = cross(normal, u),
      centre = moved(point, normal, height);
    const rim = Array.from({ length: 13 }, (_, k) => {
      const angle = (2 * Math.PI * k) / 12;
      return moved(moved(centre, u, mu * height * Math.cos(angle)), v, mu * height * Math.sin(angle));
    });
    for (let k = 0; k < 12; ++k) cones.push([rim[k], rim[k + 1]]);
    for (let k = 0; k < 12; k += 3) cones.push([point, rim[k]]);
  }
  return { arrows, cones };
}

// The most segments that forceSegments makes of so many pairs.
export const mostSegments = (pairs) => ({ arrows: 3 * pairs, cones: 16 * pairs });
