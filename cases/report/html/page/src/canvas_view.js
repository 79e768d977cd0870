// Draws the stage with lines on a plain canvas, where there is no WebGL.
import { coil, inBody, pointOf, rimsOf, turn } from "./scene_model.js";
import { colour, isDark } from "./theme.js";
import { cross } from "./vectors.js";

const edges = [
  [0, 1],
  [1, 3],
  [3, 2],
  [2, 0],
  [4, 5],
  [5, 7],
  [7, 6],
  [6, 4],
  [0, 4],
  [1, 5],
  [2, 6],
  [3, 7],
];

export class CanvasView {
  constructor(canvas, context) {
    (this.kind = "canvas"), (this.canvas = canvas), (this.context = context);
    this.pen = canvas.getContext("2d");
  }
  close() {}

  draw(panes, { trails, width, height }) {
    const ratio = Math.min(devicePixelRatio || 1, 2),
      { pen, canvas } = this;
    (canvas.width = width * ratio), (canvas.height = height * ratio);
    for (const pane of panes) {
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      pen.save();
      pen.beginPath();
      pen.rect(pane.x, pane.y, pane.width, pane.height);
      pen.clip();
      this.aim(pane);
      this.ground();
      for (const layer of pane.layers) if (!layer.isGone) this.layer(layer, trails);
      pen.restore();
    }
  }

  aim(pane) {
    const { camera } = this.context;
    (this.axes = camera.axes()), (this.eye = camera.eye());
    this.middle = [pane.x + pane.width / 2, pane.y + pane.height / 2];
    this.scale = Math.min(pane.width, pane.height) / 2 / Math.tan((camera.fov * Math.PI) / 360);
  }
  // x, y in pixels and pixels a metre there; null behind the eye.
  project(p) {
    const { eye, axes, middle } = this,
      x = p[0] - eye[0],
      y = p[1] - eye[1],
      z = p[2] - eye[2],
      along = (axis) => x * axis[0] + y * axis[1] + z * axis[2];
    const depth = -along(axes.back);
    if (depth < 1e-9) return null;
    const pixels = this.scale / depth;
    return [middle[0] + pixels * along(axes.right), middle[1] - pixels * along(axes.up), pixels];
  }
  line(points) {
    let drawing = false;
    this.pen.beginPath();
    for (const point of points) {
      const at = this.project(point);
      if (at) drawing ? this.pen.lineTo(at[0], at[1]) : this.pen.moveTo(at[0], at[1]);
      drawing = Boolean(at);
    }
    this.pen.stroke();
  }

  ground() {
    const { shapes, size, camera } = this.context,
      planes = shapes.filter((s) => s.type === "plane");
    (this.pen.strokeStyle = colour("--line")), (this.pen.lineWidth = 1);
    for (const plane of planes) {
      const n = plane.normal,
        u = Math.abs(n[0]) < 0.9 ? cross(n, [1, 0, 0]) : cross(n, [0, 1, 0]),
        length = Math.hypot(...u),
        a = u.map((v) => v / length),
        b = cross(n, a);
      const height = size.centre.reduce((sum, v, k) => sum + v * n[k], 0) - plane.offset,
        foot = size.centre.map((v, k) => v - height * n[k]);
      for (let i = -5; i <= 5; ++i) {
        const at = (s, t) => foot.map((v, k) => v + camera.radius * (0.4 * s * a[k] + 0.4 * t * b[k]));
        this.line([at(i, -5), at(i, 5)]), this.line([at(-5, i), at(5, i)]);
      }
    }
  }

  layer(layer, trails) {
    const { pen } = this,
      { shapes, springs, size } = this.context,
      { poses, engine } = layer;
    const own = engine ? engine.hex[isDark() ? 1 : 0] : colour("--truth-solid");
    pen.strokeStyle = layer.hasFailed ? colour("--bad-solid") : own;
    (pen.globalAlpha = engine ? 1 : 0.5), (pen.lineWidth = 1.5);
    const areFew = shapes.length <= 30; // more, and trails and large points hide them
    for (const shape of shapes) this.shape(shape, poses);
    pen.lineWidth = 1;
    for (const spring of springs) {
      const a = pointOf(poses, spring.a, spring.pointA),
        b = pointOf(poses, spring.b, spring.pointB);
      this.line(spring.coil ? coil(a, b, 0.025 * size.radius) : [a, b]);
    }
    for (const [a, b] of layer.jointed.marks) this.line([a, b]);
    (pen.strokeStyle = colour("--bad-solid")), (pen.lineWidth = 2.5);
    for (const [a, b] of layer.jointed.gaps) this.line([a, b]);
    (pen.strokeStyle = engine ? engine.hex[isDark() ? 1 : 0] : colour("--truth-solid")), (pen.lineWidth = 1);
    if (trails && engine && areFew) {
      pen.globalAlpha = 0.5;
      for (const { index, fixed, type } of shapes) if (!fixed && type !== "plane") this.trail(layer, index);
    }
    (pen.globalAlpha = 1), (pen.fillStyle = colour("--bad-solid"));
    const side = areFew ? 5 : 3;
    (pen.strokeStyle = colour("--ink-2")), (pen.lineWidth = 1);
    for (const [a, b] of layer.forceful.cones) this.line([a, b]);
    (pen.strokeStyle = own), (pen.lineWidth = 2.5);
    for (const [a, b] of layer.forceful.arrows) this.line([a, b]);
    for (const p of layer.contacts) {
      const at = this.project(p);
      if (at) pen.fillRect(at[0] - side / 2, at[1] - side / 2, side, side);
    }
  }

  trail({ motion, key, poses }, body) {
    const points = [];
    for (let k = 0; k <= key; ++k)
      points.push([...motion.values.subarray(7 * (k * motion.bodies + body), 7 * (k * motion.bodies + body) + 3)]);
    points.push([...poses.subarray(7 * body, 7 * body + 3)]);
    this.line(points);
  }

  shape(shape, poses) {
    const o = 7 * shape.index,
      centre = [...poses.subarray(o, o + 3)],
      q = [...poses.subarray(o + 3, o + 7)];
    const world = (p) => turn(q, inBody(shape, p)).map((v, k) => v + centre[k]);
    if (shape.type === "sphere") {
      const at = this.project(world([0, 0, 0]));
      if (!at) return;
      this.pen.beginPath(), this.pen.arc(at[0], at[1], shape.radius * at[2], 0, 7), this.pen.stroke();
      this.line([world([0, 0, 0]), world([shape.radius, 0, 0])]);
    } else if (shape.type === "box") {
      const half = shape.size.map((s) => s / 2),
        corners = [];
      for (const x of [-1, 1])
        for (const y of [-1, 1])
          for (const z of [-1, 1]) corners.push(this.project(world([x * half[0], y * half[1], z * half[2]])));
      this.pen.beginPath();
      for (const [a, b] of edges) {
        if (!corners[a] || !corners[b]) continue;
        this.pen.moveTo(corners[a][0], corners[a][1]), this.pen.lineTo(corners[b][0], corners[b][1]);
      }
      this.pen.stroke();
    } else if (shape.type === "capsule") {
      for (const end of [-0.5, 0.5]) {
        const at = this.project(world([0, 0, end * shape.length]));
        if (at) this.pen.beginPath(), this.pen.arc(at[0], at[1], shape.radius * at[2], 0, 7), this.pen.stroke();
      }
      this.line([world([0, 0, -shape.length / 2]), world([0, 0, shape.length / 2])]);
    } else if (shape.type === "cylinder") {
      const rim = rimsOf(shape).map(world),
        half = rim.length / 2;
      for (const side of [rim.slice(0, half), rim.slice(half)]) this.line([...side, side[0]]);
      for (let k = 0; k < half; k += half / 4) this.line([rim[k], rim[k + half]]);
    } else if (shape.type === "ellipsoid") {
      for (const [a, b] of [
        [0, 1],
        [1, 2],
        [2, 0],
      ])
        this.line(ring(24).map(([c, s]) => world([0, 1, 2].map((k) => shape.radii[k] * (k === a ? c : k === b ? s : 0)))));
    } else if (shape.triangles) {
      const corners = shape.points.map(world);
      for (const triangle of shape.triangles) this.line([...triangle, triangle[0]].map((k) => corners[k]));
    }
  }
}

// The cosines and sines of a closed circle.
const ring = (count) =>
  Array.from({ length: count + 1 }, (_, k) => [Math.cos((2 * Math.PI * k) / count), Math.sin((2 * Math.PI * k) / count)]);
