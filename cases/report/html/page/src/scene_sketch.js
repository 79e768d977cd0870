// A still drawing of a scene at t = 0: shapes, springs, joints and planes, in a slanted view with gravity downwards.
import { el, svg } from "./dom.js";
import { jointsOf } from "./joint_model.js";
import { coil, drawables, inBody, ownExtentOf, pointOf, rimsOf, springsOf, turn, up } from "./scene_model.js";
import { cross, dot, unit } from "./vectors.js";

const width = 340,
  height = 210,
  margin = 16,
  mostBodies = 400,
  mostFacets = 2000,
  fewNames = 4;

// The horizontal direction along which the points spread most lies across the picture; the other one is slanted.
function viewOf(scene, points) {
  const upwards = up(scene),
    one = unit(cross(Math.abs(upwards[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], upwards)),
    other = cross(one, upwards);
  const spread = (axis) => Math.max(...points.map((p) => dot(p, axis))) - Math.min(...points.map((p) => dot(p, axis)));
  const [across, away] = spread(other) >= spread(one) ? [other, one] : [one, other];
  const flat = (p) => [dot(p, across) + 0.35 * dot(p, away), dot(p, upwards) + 0.22 * dot(p, away)];
  return { flat, depth: (p) => dot(p, away) };
}

// Maps metres to the picture, so that all points and their extents fit.
function scaleOf(points, flat) {
  const low = [Infinity, Infinity],
    high = [-Infinity, -Infinity];
  for (const [p, extent] of points) {
    flat(p).forEach((v, k) => {
      low[k] = Math.min(low[k], v - extent);
      high[k] = Math.max(high[k], v + extent);
    });
  }
  const scale = Math.min((width - 2 * margin) / (high[0] - low[0] || 1), (height - 2 * margin) / (high[1] - low[1] || 1));
  const middle = [0, 1].map((k) => (low[k] + high[k]) / 2);
  const at = (p) => {
    const q = flat(p);
    return [width / 2 + scale * (q[0] - middle[0]), height / 2 - scale * (q[1] - middle[1])];
  };
  return { at, scale };
}

const text = (points) => points.map((p) => p.map((v) => v.toFixed(1)).join()).join(" ");

function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (list) => {
    const chain = [];
    for (const p of list) {
      const turnsRight = ([a, b]) => (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) <= 0;
      while (chain.length > 1 && turnsRight(chain.slice(-2))) chain.pop();
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

class Sketch {
  constructor(scene) {
    this.scene = scene;
    this.poses = Float32Array.from(scene.bodies.flatMap((b) => [...b.position, ...b.orientation_wxyz]));
    this.shapes = drawables(scene).slice(0, mostBodies);
    this.solids = this.shapes.filter((s) => s.type !== "plane");
    (this.springs = springsOf(scene)), (this.joints = jointsOf(scene).filter((j) => !j.isRod));
    const ends = [
      ...this.springs.flatMap((s) => [this.point(s.a, s.pointA), this.point(s.b, s.pointB)]),
      ...this.joints.map((j) => this.point(j.b, j.pointB)),
    ];
    const centres = this.solids.map((s) => [this.centre(s), ownExtentOf(s)]);
    const points = [...centres, ...ends.map((p) => [p, 0])];
    if (!points.length) points.push([[0, 0, 0], 1]);
    Object.assign(this, viewOf(scene, points.map(([p]) => p)));
    Object.assign(this, scaleOf(points, this.flat));
  }

  point = (body, local) => [...pointOf(this.poses, body, local)];
  // A point in the frame of a shape, which may be a part of its body.
  place = (shape, local) => this.point(shape.index, inBody(shape, local));
  centre = (shape) => this.place(shape, [0, 0, 0]);

  shape(shape) {
    const [x, y] = this.at(this.centre(shape)),
      kind = shape.fixed ? "is-fixed" : "";
    if (shape.type === "sphere") return svg("circle", { class: kind, cx: x, cy: y, r: Math.max(2, this.scale * shape.radius) });
    if (shape.type === "capsule") {
      const ends = [-1, 1].map((end) => this.at(this.place(shape, [0, 0, (end * shape.length) / 2])));
      const thick = Math.max(3, 2 * this.scale * shape.radius);
      return ["edge", "fill"].map((layer, i) =>
        svg("polyline", { class: `capsule-${layer} ${kind}`, points: text(ends), "stroke-width": thick - 3 * i }),
      );
    }
    if (shape.triangles) return this.facets(shape, kind);
    if (shape.type === "cylinder") return this.cylinder(shape, kind);
    if (shape.type === "ellipsoid") {
      const points = directions.map((n) => this.at(this.place(shape, n.map((v, k) => v * shape.radii[k]))));
      return svg("polygon", { class: kind, points: text(hull(points)) });
    }
    if (shape.type !== "box") return null;
    const corners = [];
    for (const i of [-1, 1]) for (const j of [-1, 1]) for (const k of [-1, 1]) corners.push([i, j, k]);
    const flat = corners.map((c) => this.at(this.place(shape, c.map((s, axis) => (s * shape.size[axis]) / 2))));
    const edges = corners.flatMap((a, i) =>
      corners.slice(i + 1).map((b, j) => [i, i + 1 + j]).filter(([, j]) => a.filter((v, k) => v !== corners[j][k]).length === 1),
    );
    return [
      svg("polygon", { class: kind, points: text(hull(flat)) }),
      edges.map(([i, j]) => svg("line", { class: "inner", x1: flat[i][0], y1: flat[i][1], x2: flat[j][0], y2: flat[j][1] })),
    ];
  }

  // Its outline, and the rim that is nearer.
  cylinder(shape, kind) {
    const rims = rimsOf(shape).map((p) => this.place(shape, p)),
      [one, other] = [rims.slice(0, rims.length / 2), rims.slice(rims.length / 2)],
      nearer = this.depth(one[0]) + this.depth(one[one.length / 2]) < this.depth(other[0]) + this.depth(other[one.length / 2]) ? one : other;
    return [rims, nearer].map((points) => svg("polygon", { class: kind, points: text(hull(points.map(this.at))) }));
  }

  // The triangles of a hull or a surface, the farthest first.
  facets(shape, kind) {
    const corners = shape.points.map((p) => this.place(shape, p)),
      away = (triangle) => triangle.reduce((sum, k) => sum + this.depth(corners[k]), 0);
    return [...shape.triangles]
      .sort((a, b) => away(b) - away(a))
      .slice(0, mostFacets)
      .map((triangle) => svg("polygon", { class: `facet ${kind}`, points: text(triangle.map((k) => this.at(corners[k]))) }));
  }

  // A line with hatching on the solid side; nothing for a plane that faces the reader.
  plane({ normal, offset }) {
    const [x, y] = this.at(normal.map((n) => n * offset)),
      ahead = this.at(normal.map((n) => n * (offset + 1)));
    const size = Math.hypot(ahead[0] - x, ahead[1] - y);
    if (!(size > 0.5 * this.scale)) return null;
    const n = [(ahead[0] - x) / size, (ahead[1] - y) / size],
      along = [-n[1], n[0]];
    // Centred on the part of the line nearest to the middle of the picture.
    const shift = (width / 2 - x) * along[0] + (height / 2 - y) * along[1];
    const place = (s, deep) => [x + (shift + s) * along[0] - deep * n[0], y + (shift + s) * along[1] - deep * n[1]];
    const steps = Array.from({ length: 2 * 24 + 1 }, (_, i) => 12 * (i - 24));
    return svg(
      "g",
      { class: "plane" },
      svg("polyline", { points: text([place(-400, 0), place(400, 0)]) }),
      steps.map((s) => svg("polyline", { class: "hatch", points: text([place(s, 0), place(s - 6, 7)]) })),
    );
  }

  spring({ a, pointA, b, pointB, coil: isCoil }) {
    const ends = [this.point(a, pointA), this.point(b, pointB)];
    const points = isCoil ? coil(...ends, 5 / this.scale) : ends;
    return svg("polyline", { class: isCoil ? "spring" : "rod", points: text(points.map(this.at)) });
  }

  joint({ b, pointB, axes }) {
    const p = this.point(b, pointB),
      [x, y] = this.at(p);
    const arms = axes.map(([body, axis]) => {
      const way = body < 0 ? axis : turn([...this.poses.subarray(7 * body + 3, 7 * body + 7)], axis);
      const reach = 13 / this.scale;
      return svg("polyline", { class: "axis", points: text([-1, 1].map((s) => this.at(p.map((v, k) => v + s * reach * way[k])))) });
    });
    return [arms, svg("circle", { class: "joint", cx: x, cy: y, r: 4 })];
  }

  names() {
    const moving = this.solids.filter((s, i) => !s.fixed && this.solids[i - 1]?.index !== s.index); // a body's first part
    if (moving.length > fewNames) return null;
    return moving.map((s) => {
      const [x, y] = this.at(this.centre(s));
      return svg("text", { x: Math.min(x, width - 40), y: Math.min(height - 4, y + (s.type === "sphere" ? this.scale * ownExtentOf(s) : Math.min(26, this.scale * ownExtentOf(s))) + 13), "text-anchor": "middle" }, s.name.slice(0, 24));
    });
  }

  draw(label) {
    const far = [...this.solids].sort((s, t) => this.depth(this.centre(t)) - this.depth(this.centre(s)));
    const hasGravity = Math.hypot(...this.scene.gravity) > 0;
    return svg(
      "svg",
      { viewBox: `0 0 ${width} ${height}`, class: "scene-sketch", role: "img", "aria-label": label },
      this.shapes.filter((s) => s.type === "plane").map((s) => this.plane(s)),
      this.springs.map((s) => this.spring(s)),
      far.map((s) => svg("g", { class: "solid" }, this.shape(s))),
      this.joints.map((j) => this.joint(j)),
      this.names(),
      hasGravity ? svg("path", { class: "gravity", d: `M${width - 14} 10v24m-4 -6l4 7l4 -7` }) : null,
      hasGravity ? svg("text", { x: width - 22, y: 26, "text-anchor": "end" }, "g") : null,
    );
  }
}

// Evenly over the sphere, along a spiral.
const directions = Array.from({ length: 200 }, (_, k) => {
  const z = 1 - (2 * k + 1) / 200,
    r = Math.sqrt(1 - z * z);
  return [r * Math.cos(2.39996 * k), r * Math.sin(2.39996 * k), z];
});

const counted = (n, word) => (n === 1 ? `1 ${word}` : `${n} ${word.replace(/y$/, "ie")}s`);

export function sceneSketch(scene) {
  const planes = scene.bodies.filter((b) => b.shape?.type === "plane").length;
  const parts = [
    [scene.bodies.length - planes, "body"],
    [scene.springs.length, "spring"],
    [scene.joints.length, "joint"],
    [planes, "plane"],
  ].filter(([n]) => n > 0);
  const label = `The scene at t = 0: ${parts.map(([n, word]) => counted(n, word)).join(", ") || "nothing"}`;
  return el("figure.sketch", {}, new Sketch(scene).draw(label), el("figcaption.fine", {}, `${label}.`));
}
