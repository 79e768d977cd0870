// The picture: the bodies as each run moves them, with the truth as a ghost; overlaid, or one pane a run. It draws with
// the views of the report's playback.
import { Camera, moveByHand } from "../../../report/html/page/src/camera.js";
import { CanvasView } from "../../../report/html/page/src/canvas_view.js";
import { el, replace } from "../../../report/html/page/src/dom.js";
import { jointSegments, jointsOf } from "../../../report/html/page/src/joint_model.js";
import { paneGrid } from "../../../report/html/page/src/pane_grid.js";
import { contacts, drawables, extentOf, springsOf, up } from "../../../report/html/page/src/scene_model.js";
import { onTheme } from "../../../report/html/page/src/theme.js";
import { WebglView } from "../../../report/html/page/src/webgl_view.js";
import { colours } from "./colours.js";
import { mostRuns } from "./address.js";
import { shortName } from "./run_names.js";

const mostWithoutGpu = 100;
const nothing = { arrows: [], cones: [] };
const still = (bodies) => ({ times: [], values: new Float32Array(), bodies });

export class Picture {
  constructor(root) {
    this.root = root;
    this.names = [];
    this.stopTheme = onTheme(() => (this.view?.recolour?.(), this.invalidate()));
    this.resize = new ResizeObserver(() => this.invalidate());
    this.resize.observe(root);
  }

  // A scene as JSON of the case file.
  show(scene) {
    this.view?.close();
    this.scene = scene;
    this.joints = jointsOf(scene);
    this.shapes = drawables(scene).map((s) => ({ ...s, collides: scene.bodies[s.index].collides }));
    this.camera = new Camera(up(scene));
    const layer = (name, engine) => ({
      ...{ name, engine, motion: still(scene.bodies.length), poses: startOf(scene), contacts: [], key: -1 },
      ...{ jointed: { marks: [], gaps: [] }, forceful: nothing, isGone: false, hasFailed: false },
    });
    this.ghost = layer("truth", null);
    this.layers = Array.from({ length: mostRuns }, (_, k) => layer(`run ${k}`, { hex: colours[k] }));
    this.openView();
    moveByHand(this.camera, this.surface, () => this.invalidate());
    this.labels = el("div.panes");
    replace(this.root, el("div.surface", {}, this.surface, this.labels));
    this.frameAll();
  }

  openView() {
    const context = {
      ...{ shapes: this.shapes, springs: springsOf(this.scene), joints: this.joints, camera: this.camera },
      ...{ layers: [this.ghost, ...this.layers], size: this.bounds() },
    };
    const surface = () => el("canvas", { tabindex: 0, "aria-label": "The bodies in motion; drag to turn the picture" });
    this.surface = surface();
    try {
      this.view = new WebglView(this.surface, context, { onlyWithGpu: this.shapes.length > mostWithoutGpu });
    } catch {
      this.surface = surface();
      this.view = new CanvasView(this.surface, context);
    }
    this.surface.dataset.kind = this.view.kind;
  }

  // The box around the bodies at the start, the fixed ends of springs, and all that the truth passes through.
  bounds(truth = null) {
    const low = [Infinity, Infinity, Infinity],
      high = [-Infinity, -Infinity, -Infinity];
    const include = (p, r) =>
      p.forEach((v, k) => ((low[k] = Math.min(low[k], v - r)), (high[k] = Math.max(high[k], v + r))));
    const solid = this.shapes.filter((shape) => shape.type !== "plane");
    for (const shape of solid) include([...this.scene.bodies[shape.index].position], extentOf(shape));
    for (const spring of springsOf(this.scene)) if (spring.a < 0) include(spring.pointA, 0);
    const moving = solid.filter((shape) => !shape.fixed);
    for (let row = 0; truth?.table && row + truth.columns <= truth.table.length; row += truth.columns) {
      if (truth.table[row + truth.columns - 1] > 1e-2) break;
      for (const shape of moving) {
        const at = row + 13 * shape.index;
        include([...truth.table.subarray(at, at + 3)], extentOf(shape));
      }
    }
    if (!(low[0] <= high[0])) return { centre: [0, 0, 0], radius: 1, low: [-1, -1, -1], high: [1, 1, 1] };
    const radius = Math.max(Math.hypot(...low.map((v, k) => high[k] - v)) / 2, 1e-3);
    return { centre: low.map((v, k) => (v + high[k]) / 2), radius, low, high };
  }

  frameAll(truth = null) {
    const { centre, radius } = this.bounds(truth);
    this.camera.frame(centre, radius);
    this.invalidate();
  }

  // What the bench holds, and how it is laid out.
  update(bench, { layout, truth }) {
    this.names = bench.runs.map((run) => shortName(run.name));
    this.isSide = layout === "side" && bench.runs.length > 1;
    const ghost = truth ? bench.truthPoses() : null;
    this.hasGhost = ghost !== null;
    if (ghost) this.ghost.poses = ghost;
    const near = 0.004 * (this.camera.radius ?? 1);
    bench.runs.forEach((run, k) => {
      const layer = this.layers[k];
      layer.isGone = !run.poses || run.why !== "";
      layer.hasFailed = run.cell?.verdict?.word === "blown up" || run.ended !== "";
      if (!run.poses) return;
      layer.poses = run.poses;
      layer.contacts = contacts(this.shapes, run.poses, near);
      const { radius } = this.camera;
      if (this.joints.length) layer.jointed = jointSegments(this.joints, run.poses, 0.025 * radius, 0.004 * radius);
    });
    this.count = bench.runs.length;
    this.invalidate();
  }

  panes() {
    const ghost = this.hasGhost ? [this.ghost] : [],
      layers = this.layers.slice(0, this.count ?? 0);
    if (!this.isSide) return [{ layers: [...ghost, ...layers] }];
    return layers.map((layer) => ({ layers: [...ghost, layer] }));
  }

  invalidate() {
    if (this.isWaiting || !this.view) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.draw();
    });
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.surface;
    if (!(width > 0 && height > 0)) return;
    const placed = paneGrid(this.panes(), width, height);
    this.view.draw(placed, { trails: false, width, height });
    this.surface.dataset.frames = Number(this.surface.dataset.frames ?? 0) + 1;
    const named = this.isSide ? placed : [];
    if (this.labels.children.length !== named.length || this.labelled !== this.names.join()) {
      this.labelled = this.names.join();
      replace(
        this.labels,
        named.map((_, k) => el(`span.run-${k}`, {}, this.names[k])),
      );
    }
    named.forEach(({ x, y }, k) => {
      this.labels.children[k].style.left = `${x + 8}px`;
      this.labels.children[k].style.top = `${y + 6}px`;
    });
  }
}

function startOf(scene) {
  const poses = new Float64Array(7 * scene.bodies.length);
  scene.bodies.forEach((body, i) => poses.set([...body.position, ...body.orientation_wxyz], 7 * i));
  return poses;
}
