// The picture: each engine's bodies as it moves them, with the truth as a ghost; overlaid, or one pane an engine.
import { Camera, moveByHand } from "./camera.js";
import { CanvasView } from "./canvas_view.js";
import { cellOf, failedAt, judgement } from "./data.js";
import { el, replace } from "./dom.js";
import { digits, quantity } from "./format.js";
import { forceSegments, forcesAt, frictionOf, usualForce } from "./force_model.js";
import { jointSegments, jointsOf } from "./joint_model.js";
import { paneGrid as grid } from "./pane_grid.js";
import { valueAt } from "./playback_data.js";
import { contacts, drawables, extentOf, springsOf, up } from "./scene_model.js";
import { onTheme } from "./theme.js";
import { WebglView } from "./webgl_view.js";
import { set, state } from "./state.js";

const mostWithoutGpu = 100; // bodies: more of them, shaded without a GPU, make the page slow
const longHold = 50; // ms: more, and a reader's keys and mouse seem to lag

export class Stage {
  constructor(results, one, data, player, root) {
    Object.assign(this, { results, one, data, player, root, engines: [], dirty: true });
    this.flags = { truth: true, trails: true, contacts: true, joints: true, forces: true };
    this.joints = jointsOf(one.scene);
    this.friction = frictionOf(one.scene);
    this.usual = usualForce([...data.runs.values()]); // N; 0 if no engine told its forces
    this.shapes = drawables(one.scene).map((s) => ({ ...s, collides: one.scene.bodies[s.index].collides }));
    this.camera = new Camera(up(one.scene));
    this.layers = new Map();
    if (data.truth?.motion) this.layers.set("truth", this.layer("truth", null, data.truth));
    for (const engine of results.engines) {
      const run = data.runs.get(engine.name);
      if (run?.motion) this.layers.set(engine.name, this.layer(engine.name, engine, run));
    }
    this.build();
    this.frameAll();
    this.stops = [player.onTick(() => this.tick()), onTheme(() => (this.view.recolour?.(), this.invalidate()))];
    this.observer = new ResizeObserver(() => this.invalidate());
    this.observer.observe(this.surface);
    this.invalidate();
  }
  close() {
    this.closed = true;
    this.stops.forEach((stop) => stop());
    this.observer.disconnect();
    this.view.close();
  }

  layer(name, engine, { motion, forces }) {
    return { name, engine, motion, forces, poses: new Float32Array(7 * motion.bodies), visible: false };
  }

  build() {
    this.openView();
    moveByHand(this.camera, this.surface, () => this.invalidate());
    this.panes = el("div.panes");
    this.buildControls();
    this.notes = el("p.fine.stage-note");
    replace(this.root, el("div.surface", {}, this.surface, this.panes), this.transportBar(), this.flagBar(), this.notes);
  }

  // With WebGL, or with lines on a canvas where the browser lacks it.
  openView() {
    const context = {
      shapes: this.shapes,
      springs: springsOf(this.one.scene),
      joints: this.joints,
      layers: [...this.layers.values()],
      camera: this.camera,
      size: this.bounds(),
    };
    const surface = () => el("canvas", { tabindex: 0, "aria-label": "The bodies in motion; drag to turn" });
    const isLarge = this.shapes.length > mostWithoutGpu;
    this.surface = surface();
    this.note = "";
    try {
      this.view = new WebglView(this.surface, context, { onlyWithGpu: isLarge });
    } catch (error) {
      this.surface = surface();
      this.view = new CanvasView(this.surface, context);
      this.note = isLarge
        ? "This browser has no GPU for WebGL, so the picture of so many bodies is drawn with lines."
        : "This browser has no WebGL, so the picture is drawn with lines.";
    }
    this.surface.dataset.kind = this.view.kind;
  }

  buildControls() {
    this.clock = el("output.clock");
    this.slider = el("input", {
      type: "range",
      min: 0,
      max: this.player.duration,
      step: "any",
      value: 0,
      "aria-label": "Time",
      oninput: (event) => this.player.seek(Number(event.target.value)),
    });
    this.play = el("button.play", { type: "button", onclick: () => this.player.toggle(), title: "space" });
    this.speed = el("button.quiet", {
      type: "button",
      title: "faster; with shift slower (+ −)",
      onclick: (event) => this.player.faster(event.shiftKey ? 0.5 : this.player.speed >= 16 ? 1 / 64 : 2),
    });
    this.sideButton = el("button.quiet", {
      type: "button",
      title: "o, s",
      onclick: () => set({ layout: state.layout === "side" ? "overlay" : "side" }),
    });
    this.failures = el("div.failures", { "aria-hidden": "true" });
  }

  // Play, step, the line of time and the clock.
  transportBar() {
    const step = (by, sign, title) =>
      el("button.quiet", { type: "button", title, "aria-label": title, onclick: () => this.player.step(by) }, sign);
    return el(
      "div.transport",
      {},
      step(-1, "‹", "one step back"),
      this.play,
      step(1, "›", "one step on"),
      el("div.timeline", {}, this.slider, this.failures),
      this.clock,
      this.speed,
    );
  }

  // The buttons that show and hide parts of the picture.
  flagBar() {
    const flag = (name, label) =>
      el(
        "button.quiet",
        { type: "button", "data-flag": name, "aria-pressed": "true", onclick: () => this.flip(name) },
        label,
      );
    this.flagButtons = [flag("truth", "truth"), flag("trails", "trails"), flag("contacts", "contacts")];
    if (this.joints.length) this.flagButtons.push(flag("joints", "joints"));
    if (this.usual > 0) this.flagButtons.push(flag("forces", "forces"));
    return el(
      "div.flags",
      {},
      this.sideButton,
      this.flagButtons,
      el("button.quiet", { type: "button", title: "f", onclick: () => this.frameAll() }, "whole scene"),
    );
  }

  // The box around all that is expected to move, from the truth if there is one.
  bounds() {
    const low = [Infinity, Infinity, Infinity],
      high = [-Infinity, -Infinity, -Infinity];
    const include = (p, r) =>
      p.forEach((v, k) => ((low[k] = Math.min(low[k], v - r)), (high[k] = Math.max(high[k], v + r))));
    const largest = Math.max(...this.shapes.map(extentOf), 1e-3);
    this.shapes.forEach(
      (shape) => shape.type !== "plane" && include(this.one.scene.bodies[shape.index].position, extentOf(shape)),
    );
    for (const s of springsOf(this.one.scene)) if (s.a < 0) include(s.pointA, 0);
    // Without a truth to say how far bodies are meant to come, one that runs away must not make the rest small.
    const limit = this.data.truth?.motion ? null : reachOf(low, high);
    const tame = [...this.layers.values()].filter((l) => !l.engine || judgement(this.cell(l.engine)).kind !== "bad");
    for (const { motion } of this.data.truth?.motion ? [this.layers.get("truth")] : tame) {
      if (!motion?.low) continue;
      const within = (v, k) => (limit ? Math.min(limit.high[k], Math.max(limit.low[k], v)) : v);
      include(motion.low.map(within), largest),
        include(
          motion.low.map((v, k) => within(v + motion.extent[k], k)),
          largest,
        );
    }
    if (!(low[0] <= high[0])) return { centre: [0, 0, 0], radius: 1, low: [-1, -1, -1] };
    return {
      centre: low.map((v, k) => (v + high[k]) / 2),
      radius: Math.max(Math.hypot(...low.map((v, k) => high[k] - v)) / 2, 1e-3),
      low,
      high,
    };
  }

  cell(engine) {
    return (
      this.one.cells.find((c) => c.engine === engine.name && c.dt === this.dtText()) ??
      cellOf(this.one, engine.name, this.one.coarsest.text)
    );
  }
  dtText() {
    return (this.one.dt.find((dt) => dt.text === state.dt) ?? this.one.coarsest).text;
  }

  frameAll() {
    const { centre, radius } = this.bounds();
    this.camera.frame(centre, radius);
    this.invalidate();
  }

  show(engines) {
    this.engines = engines;
    this.markFailures();
    this.arrange();
  }
  arrange() {
    this.sideButton.textContent = state.layout === "side" ? "overlay" : "side by side";
    this.flagButtons.forEach((button) => button.setAttribute("aria-pressed", String(this.flags[button.dataset.flag])));
    this.invalidate();
  }
  flip(name) {
    this.flags[name] = !this.flags[name];
    this.arrange();
  }

  // On the time line, a mark where a run that is shown blew up or collapsed.
  markFailures() {
    const marks = this.engines
      .map((engine) => [engine, failedAt(this.cell(engine))])
      .filter(([, time]) => time !== null && time <= this.player.duration)
      .map(([engine, time]) =>
        el(
          "span",
          {
            style: { left: `${(100 * time) / this.player.duration}%`, "--engine": `var(--e${engine.index})` },
            title: `${engine.name}: ${judgement(this.cell(engine)).word}`,
          },
          "✕",
        ),
      );
    replace(this.failures, marks);
  }

  // What each pane shows.
  arrangement() {
    const layers = this.engines.map((e) => this.layers.get(e.name)).filter(Boolean);
    const ghost = this.flags.truth ? this.layers.get("truth") : null;
    if (state.layout !== "side" || layers.length < 2)
      return [{ layers: [ghost, ...layers].filter(Boolean), engine: null }];
    return layers.map((layer) => ({ layers: [ghost, layer].filter(Boolean), engine: layer.engine }));
  }

  tick() {
    this.slider.value = this.player.time;
    this.play.textContent = this.player.playing ? "❚❚" : "▶";
    this.play.setAttribute("aria-label", this.player.playing ? "Pause" : "Play");
    this.speed.textContent = `× ${digits(this.player.speed)}`;
    this.clock.textContent = `${this.player.time.toFixed(3)} s`;
    this.invalidate();
  }

  // Draws once before the next frame, and only if anything changed. Without a GPU a picture can hold the page up: then
  // it gets as long a rest after each as that took.
  invalidate() {
    if (this.waiting || this.closed) return;
    this.waiting = true;
    const rest = (this.restUntil ?? 0) - performance.now();
    if (rest > 0) setTimeout(() => requestAnimationFrame(() => this.drawAtLast()), rest);
    else requestAnimationFrame(() => this.drawAtLast());
  }
  drawAtLast() {
    this.waiting = false;
    if (this.closed) return;
    const began = performance.now();
    this.draw();
    requestAnimationFrame(() => {
      const now = performance.now(),
        took = now - began; // up to the next frame, when the page could do something else again
      this.view.keepPace?.(took);
      this.restUntil = took > longHold ? now + Math.min(took, 500) : 0;
    });
  }

  draw() {
    const { time } = this.player,
      near = 0.004 * this.bounds().radius,
      gone = [],
      failed = [];
    const panes = this.arrangement();
    for (const layer of new Set(panes.flatMap((p) => p.layers))) {
      layer.motion.posesAt(time, layer.poses);
      layer.isGone =
        time > layer.motion.end + 1.5 * this.player.dt && layer.motion.end < this.player.duration - 1.5 * this.player.dt;
      layer.contacts =
        this.flags.contacts && !layer.isGone && layer.name !== "truth" ? contacts(this.shapes, layer.poses, near) : [];
      layer.jointed = this.jointed(layer);
      layer.forceful = this.forceful(layer);
      layer.key = layer.motion.keyAt(time);
      const failure = layer.engine ? failedAt(this.cell(layer.engine)) : null;
      layer.hasFailed = failure !== null && time >= failure;
      if (layer.hasFailed) failed.push(`${layer.name} at ${failure.toFixed(2)} s`);
      if (layer.isGone) gone.push(`${layer.name} at ${layer.motion.end.toFixed(2)} s`);
    }
    const width = this.surface.clientWidth,
      height = this.surface.clientHeight;
    if (width > 0 && height > 0)
      this.view.draw(grid(panes, width, height), { trails: this.flags.trails, width, height });
    this.label(panes, width, height);
    const kept = this.engines.filter((e) => !this.layers.has(e.name));
    const horizon = this.one.truth.horizon,
      past = this.one.truth.kind !== "recording" && this.flags.truth && this.layers.has("truth") && horizon !== undefined && time > horizon + 1e-9;
    const text = [
      this.note,
      failed.length ? `✕ Failed, drawn in red: ${failed.join(", ")}.` : "",
      gone.length ? `Out of the picture: ${gone.join(", ")}.` : "",
      kept.length ? `No motion was kept of ${kept.map((e) => e.name).join(", ")}.` : "",
      past ? `The truth is past its horizon of ${horizon.toFixed(1)} s.` : "",
      this.gapsNow(time),
    ]
      .filter(Boolean)
      .join(" ");
    if (this.notes.textContent !== text) this.notes.textContent = text;
    this.surface.dataset.frames = Number(this.surface.dataset.frames ?? 0) + 1;
  }

  // Gaps of less than a few thousandths of the picture are not to be seen in it.
  jointed(layer) {
    if (!this.flags.joints || layer.isGone || !this.joints.length) return { marks: [], gaps: [] };
    const { radius } = this.bounds();
    return jointSegments(this.joints, layer.poses, 0.025 * radius, layer.engine ? 0.004 * radius : Infinity);
  }

  // A usual force is a third of the scene long.
  forceful(layer) {
    if (!this.flags.forces || layer.isGone || !(this.usual > 0)) return { arrows: [], cones: [] };
    const { radius } = this.bounds();
    const found = forcesAt(layer.forces, this.player.time, this.one.scene.bodies);
    return forceSegments(found, this.friction, radius / 3 / this.usual, radius);
  }

  // The widest gap of any joint of each engine shown, as it was measured.
  gapsNow(time) {
    if (!this.flags.joints || !this.joints.length) return "";
    const told = this.engines
      .map((e) => [e.name, valueAt(this.data.runs.get(e.name)?.series.joint_gap ?? { times: [], values: [] }, time)])
      .filter(([, gap]) => gap !== null)
      .map(([name, gap]) => `${name} ${quantity(gap, "m")}`);
    return told.length ? `Widest joint gap: ${told.join(", ")}.` : "";
  }

  label(panes, width, height) {
    const wanted = panes.length > 1 ? panes.map((p) => p.engine.name).join("|") : "";
    if (this.labelled !== wanted) {
      this.labelled = wanted;
      replace(
        this.panes,
        panes.length > 1
          ? panes.map((p) =>
              el("span", { style: { "--engine": `var(--e${p.engine.index})` } }, p.engine.name.replace("core:", "")),
            )
          : [],
      );
    }
    grid(panes, width, height).forEach(({ x, y }, i) => {
      const child = this.panes.children[i];
      if (child) (child.style.left = `${x + 8}px`), (child.style.top = `${y + 6}px`);
    });
  }
}

// Twice a box.
function reachOf(low, high) {
  const half = 0.5 * Math.hypot(...low.map((v, k) => high[k] - v));
  return { low: low.map((v) => v - half), high: high.map((v) => v + half) };
}
