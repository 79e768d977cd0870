// A scene for drawing: shapes with their sizes, springs with their ends, contact points, and the up direction.
export function drawables(scene) {
  const reach = Math.max(...scene.bodies.map((b) => Math.hypot(...b.position)), 0.5);
  return scene.bodies.flatMap((body, index) =>
    partsOf(shapeOf(body, reach)).map((part) => ({ index, name: body.name, fixed: body.fixed, ...part })),
  );
}

// The parts of a compound, each with its pose in the body as `at`; else the shape itself.
function partsOf(shape) {
  if (shape.type !== "compound") return [shape];
  return shape.parts.map(({ position, orientation_wxyz, ...part }) => ({
    ...part,
    at: { position, turn: orientation_wxyz },
  }));
}

// A point of a shape in the frame of its body.
export function inBody(shape, point) {
  if (!shape.at) return point;
  return turn(shape.at.turn, point).map((v, k) => v + shape.at.position[k]);
}

// A body without a shape is drawn as the solid box that has its inertia, or a small one.
function shapeOf(body, reach) {
  if (body.shape) return { ...body.shape };
  const [xx, yy, zz] = body.inertia;
  const size = [yy + zz - xx, xx + zz - yy, xx + yy - zz].map((v) => Math.sqrt(Math.max(0, (6 * v) / body.mass)));
  const largest = Math.max(...size);
  if (body.fixed || !(largest > 0) || !Number.isFinite(largest))
    return { type: "box", size: [0.05, 0.05, 0.05].map((s) => s * reach), bare: true };
  const limit = Math.min(1, (1.5 * reach) / largest);
  return { type: "box", size: size.map((s) => Math.max(s, 0.03 * largest) * limit), bare: true };
}

export function extentOf(shape) {
  const away = shape.at ? Math.hypot(...shape.at.position) : 0;
  return away + ownExtentOf(shape);
}

export function ownExtentOf(shape) {
  if (shape.type === "sphere") return shape.radius;
  if (shape.type === "cylinder") return Math.hypot(shape.radius, shape.length / 2);
  if (shape.type === "ellipsoid") return Math.max(...shape.radii);
  if (shape.triangles) return Math.max(...shape.points.map((p) => Math.hypot(...p)));
  if (shape.type === "capsule") return shape.radius + shape.length / 2;
  if (shape.type === "box") return Math.hypot(...shape.size) / 2;
  return 0;
}

export const up = (scene) => {
  const size = Math.hypot(...scene.gravity);
  return size > 0 ? scene.gravity.map((g) => -g / size) : [0, 1, 0];
};

export function turn(q, v) {
  // q = [w, x, y, z]
  const [w, x, y, z] = q;
  const tx = 2 * (y * v[2] - z * v[1]),
    ty = 2 * (z * v[0] - x * v[2]),
    tz = 2 * (x * v[1] - y * v[0]);
  return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx];
}

export function pointOf(poses, body, point) {
  if (body < 0) return point;
  const o = 7 * body,
    turned = turn(poses.slice(o + 3, o + 7), point);
  return [poses[o] + turned[0], poses[o + 1] + turned[1], poses[o + 2] + turned[2]];
}

export function springsOf(scene) {
  const index = new Map(scene.bodies.map((b, i) => [b.name, i]));
  const ends = scene.springs.map((s) => ({
    a: index.get(s.a) ?? -1,
    pointA: s.point_a,
    b: index.get(s.b) ?? -1,
    pointB: s.point_b,
    rest: s.rest_length,
    coil: true,
  }));
  const rods = scene.joints
    .filter((j) => j.type === "distance")
    .map((j) => ({
      a: index.get(j.a) ?? -1,
      pointA: j.point_a,
      b: index.get(j.b) ?? -1,
      pointB: j.point_b,
      coil: false,
    }));
  return [...ends, ...rods];
}

// A coil from a to b as points; `width` its radius.
export function coil(a, b, width, turns = 9, steps = 8) {
  const along = [b[0] - a[0], b[1] - a[1], b[2] - a[2]],
    length = Math.hypot(...along);
  if (!(length > 0)) return [a, b];
  const d = along.map((v) => v / length),
    side = Math.abs(d[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0];
  let u = [d[1] * side[2] - d[2] * side[1], d[2] * side[0] - d[0] * side[2], d[0] * side[1] - d[1] * side[0]];
  const norm = Math.hypot(...u);
  u = u.map((v) => v / norm);
  const v = [d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0]];
  const points = [a],
    count = turns * steps;
  for (let i = 0; i <= count; ++i) {
    const share = 0.08 + (0.84 * i) / count,
      angle = (2 * Math.PI * i) / steps,
      radius = i === 0 || i === count ? 0 : width;
    points.push(
      [0, 1, 2].map((k) => a[k] + share * along[k] + radius * (Math.cos(angle) * u[k] + Math.sin(angle) * v[k])),
    );
  }
  points.push(b);
  return points;
}

// Points at which shapes touch or overlap in these poses: spheres, capsules and the corners of boxes, against planes
// and against spheres and boxes. `near` is the largest gap that counts.
export function contacts(shapes, poses, near, most = 400) {
  const found = [],
    probes = [];
  const planes = shapes.filter((s) => s.type === "plane");
  for (const shape of shapes) {
    if (shape.type === "plane" || shape.collides === false) continue;
    for (const [local, radius] of probesOf(shape))
      probes.push([pointOf(poses, shape.index, inBody(shape, local)), radius, shape]);
  }
  for (const [p, radius] of probes) {
    for (const plane of planes) {
      const gap = p[0] * plane.normal[0] + p[1] * plane.normal[1] + p[2] * plane.normal[2] - plane.offset - radius;
      if (gap < near) found.push([0, 1, 2].map((k) => p[k] - plane.normal[k] * (radius + gap / 2)));
      if (found.length >= most) return found;
    }
  }
  const round = probes.filter(([, radius]) => radius > 0).sort((a, b) => a[0][0] - a[1] - (b[0][0] - b[1]));
  for (let i = 0; i < round.length; ++i) {
    const [p, r, one] = round[i];
    for (let j = i + 1; j < round.length && round[j][0][0] - round[j][1] < p[0] + r + near; ++j) {
      const [q, s, other] = round[j],
        gap = Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) - r - s;
      if (one.index !== other.index && gap < near)
        found.push([0, 1, 2].map((k) => p[k] + ((q[k] - p[k]) * (r + gap / 2)) / (r + s + gap || 1)));
      if (found.length >= most) return found;
    }
  }
  const boxes = shapes.filter((s) => s.type === "box" && !s.at && s.collides !== false);
  if (boxes.length * probes.length > 40000) return found;
  for (const box of boxes) {
    const o = 7 * box.index,
      [w, x, y, z] = poses.slice(o + 3, o + 7),
      half = box.size.map((s) => s / 2);
    for (const [p, radius, shape] of probes) {
      if (shape.index === box.index || found.length >= most) continue;
      const local = turn([w, -x, -y, -z], [p[0] - poses[o], p[1] - poses[o + 1], p[2] - poses[o + 2]]);
      const closest = local.map((v, k) => Math.min(half[k], Math.max(-half[k], v)));
      if (Math.hypot(...local.map((v, k) => v - closest[k])) < radius + near)
        found.push(pointOf(poses, box.index, closest));
    }
  }
  return found;
}

function probesOf(shape) {
  if (shape.bare) return [];
  if (shape.type === "sphere") return [[[0, 0, 0], shape.radius]];
  if (shape.type === "capsule") return [-1, 0, 1].map((end) => [[0, 0, (end * shape.length) / 2], shape.radius]);
  if (shape.triangles) return shape.points.map((point) => [point, 0]);
  if (shape.type === "cylinder") return rimsOf(shape).map((point) => [point, 0]);
  if (shape.type !== "box") return [];
  const corners = [];
  for (const x of [-1, 1])
    for (const y of [-1, 1])
      for (const z of [-1, 1])
        corners.push([[(x * shape.size[0]) / 2, (y * shape.size[1]) / 2, (z * shape.size[2]) / 2], 0]);
  return corners;
}

// Points of both rims of a cylinder.
export function rimsOf(shape, count = 16) {
  return [-0.5, 0.5].flatMap((end) =>
    Array.from({ length: count }, (_, k) => {
      const angle = (2 * Math.PI * k) / count;
      return [shape.radius * Math.cos(angle), shape.radius * Math.sin(angle), end * shape.length];
    }),
  );
}
