// The picture of the first screen: error against cost on logarithmic axes, a curve for each engine over its steps, and
// the tolerance as a line that can be dragged or moved by keys.
import { add, el, replace, svg } from "./dom.js";
import { bounds, decades, ink } from "./charts.js";
import { digits, isNumber, quantity } from "./format.js";
import { mainCurves, mayBeTaken, meets } from "./frontier.js";
import { saveButtons } from "./saving.js";

const width = 780,
  height = 470,
  left = 66,
  top = 30,
  bottom = 48;

export const lengthOrAngle = (value) => quantity(value, "m");

// Options of a run go into its title; a name of the core's method is long enough without them.
const shortName = (curve) => `${curve.engine.split(",")[0]}${curve.reference ? " (reference)" : ""}`;

export class FrontierChart {
  // `pickTolerance` is told of a new tolerance, `pickRun` of a curve that was clicked.
  // `isOneCase`: each dot is one run; `pickRun` is absent where nothing follows from a click on a curve.
  constructor({ timed, pickTolerance, pickRun, isOneCase = false }) {
    Object.assign(this, { timed, isOneCase });
    this.pickTolerance = pickTolerance;
    this.pickRun = pickRun;
    this.root = el("figure.frontier", {});
    this.withAll = false;
  }

  draw({ curves, tolerance, chosen, focus }) {
    Object.assign(this, { curves, tolerance, chosen, focus });
    const main = mainCurves(curves, tolerance);
    const shown = this.withAll ? curves : main;
    this.right = 26 + 7.2 * Math.max(...main.map((c) => shortName(c).length), 10);
    this.scale(curves, tolerance);
    const picture = svg("svg", {
      viewBox: `0 0 ${width} ${height}`,
      class: "chart frontier-chart",
      role: "group",
      "aria-label": this.inWords(main),
    });
    add(picture, [
      this.axes(),
      this.band(main),
      shown.filter((c) => !main.includes(c)).map((c) => this.curve(c, "is-faint")),
      main.map((c) => this.curve(c, c.reference ? "is-reference" : "")),
      this.marks(),
      this.line(),
      this.names(main),
    ]);
    this.picture = picture;
    replace(this.root, this.caption(main), picture, this.tools());
  }

  scale(curves, tolerance) {
    const points = curves.flatMap((c) => c.points).filter((p) => p.cost > 0 && isNumber(p.mean));
    const xs = bounds(points.map((p) => p.cost)),
      ys = bounds([tolerance, ...points.map((p) => p.mean)]);
    ys[0] = Math.max(ys[0], Math.min(1e-8, tolerance / 10)); // smaller errors lie on the axis
    this.x = decades(xs[0], xs[1], left, width - this.right);
    this.y = decades(ys[0], ys[1], height - bottom, top);
    this.range = ys;
  }

  caption(main) {
    const curve = this.isOneCase ? null : this.curveOfBand(main);
    return el("figcaption", {}, el("b", {}, "Error against cost"), ": lower left is better. A dot is a step size.", curve ? ` The band: 80 % of the cases of ${curve.engine}.` : "");
  }

  axes() {
    return [
      this.x.ticks.map(([value, text]) => [
        svg("line", { class: "grid", x1: this.x.at(value), x2: this.x.at(value), y1: top, y2: height - bottom }),
        svg("text", { x: this.x.at(value), y: height - bottom + 17, "text-anchor": "middle" }, this.timed ? quantity(value, "s") : text),
      ]),
      this.y.ticks.map(([value]) => [
        svg("line", { class: "grid", x1: left, x2: width - this.right, y1: this.y.at(value), y2: this.y.at(value) }),
        svg("text", { x: left - 7, y: this.y.at(value) + 4, "text-anchor": "end" }, lengthOrAngle(value)),
      ]),
      svg(
        "text",
        { class: "axis", x: (left + width - this.right) / 2, y: height - 8, "text-anchor": "middle" },
        this.timed ? "cost: CPU time per simulated second →" : "steps per simulated second (nothing was timed) →",
      ),
      svg("text", { class: "axis", x: 6, y: top - 14 }, this.isOneCase ? "↑ error (rad where nothing moves away)" : "↑ typical error: geometric mean over the cases (rad where nothing moves away)"),
    ];
  }

  cost = (p) => (this.timed ? `${quantity(p.cost, "s")} of CPU time` : `${digits(p.cost)} steps a second`);

  place = (p) => [this.x.at(p.cost), this.y.at(p.mean)];

  drawable = (curve) => curve.points.filter((p) => p.cost > 0 && isNumber(p.mean));

  curveOfBand = (main) => main.find((c) => c.engine === this.focus) ?? this.chosen?.curve;

  // From the 10th to the 90th percentile, of the curve in focus or of the recommended one.
  band(main) {
    const curve = this.curveOfBand(main);
    if (!curve) return null;
    const points = this.drawable(curve),
      high = (p) => (isNumber(p.high) ? this.y.at(Math.min(p.high, this.range[1])) : top),
      low = (p) => (isNumber(p.low) ? this.y.at(Math.max(p.low, this.range[0])) : this.place(p)[1]);
    const corners = [
      ...points.map((p) => [this.x.at(p.cost), high(p)]),
      ...[...points].reverse().map((p) => [this.x.at(p.cost), low(p)]),
    ];
    return svg(
      "polygon",
      { class: "band", points: corners.map((c) => c.map((v) => v.toFixed(1)).join()).join(" "), fill: ink(curve.run) },
      svg("title", {}, `${curve.engine}: 10th to 90th percentile of the cases`),
    );
  }

  curve(curve, kind) {
    const points = this.drawable(curve);
    const counts = (p) => (this.isOneCase ? "" : `; ${p.cases} cases, ${p.failed} failed`);
    const text = (p) => `${curve.engine} at ${p.dt} s: ${lengthOrAngle(p.mean)} for ${this.cost(p)}${counts(p)}`;
    return svg(
      "g",
      { class: `curve ${kind}`, onclick: this.pickRun && (() => this.pickRun(curve.engine)) },
      svg("polyline", {
        points: points.map((p) => this.place(p).map((v) => v.toFixed(1)).join()).join(" "),
        fill: "none",
        stroke: ink(curve.run),
        "stroke-dasharray": curve.reference ? "2 4" : curve.run.dash?.join(" "),
      }),
      points.map((p) => {
        const [x, y] = this.place(p),
          failed = !mayBeTaken(p),
          hidden = !failed && p.mean <= this.tolerance && !meets(p, this.tolerance); // most cases are beyond it
        return svg(
          "g",
          { class: "pick" },
          svg("circle", { cx: x, cy: y, r: 4.5, fill: failed || hidden ? "var(--raised)" : ink(curve.run), stroke: ink(curve.run) }),
          failed ? svg("path", { d: `M${x - 3} ${y - 3}l6 6m0-6l-6 6`, stroke: "var(--bad-solid)", "stroke-width": 2 }) : null,
          svg("title", {}, text(p)),
        );
      }),
    );
  }

  // A ring about the recommended point, and its step.
  marks() {
    if (!this.chosen) return null;
    const [x, y] = this.place(this.chosen.point),
      isRight = x > width - this.right - 120;
    return [
      svg("circle", { class: "ring", cx: x, cy: y, r: 10 }),
      svg("text", { class: "strong ring-text", x: isRight ? x - 13 : x + 13, y: y > height - bottom - 30 ? y - 12 : y + 17, "text-anchor": isRight ? "end" : "start" }, `${this.chosen.curve.engine}, ${this.chosen.point.dt} s`),
    ];
  }

  // At the finest step of each curve, moved apart where they would lie over each other.
  names(main) {
    const rows = main
      .map((curve) => ({ curve, at: this.place(this.drawable(curve).at(-1)) }))
      .sort((a, b) => a.at[1] - b.at[1]);
    let last = top - 20;
    for (const row of rows) last = row.y = Math.max(row.at[1] + 4, last + 15);
    const over = Math.max(0, last - (height - bottom));
    return rows.map(({ curve, at, y }) => [
      svg("line", { class: "leader", x1: at[0] + 6, y1: at[1], x2: width - this.right + 8, y2: y - over - 4 }),
      svg(
        "text",
        { class: "curve-name", x: width - this.right + 11, y: y - over, fill: ink(curve.run), style: { fill: ink(curve.run) } },
        shortName(curve),
      ),
    ]);
  }

  line() {
    const y = this.y.at(this.tolerance);
    const grip = svg(
      "g",
      {
        class: "tolerance",
        tabindex: 0,
        role: "slider",
        "aria-label": "Tolerance",
        "aria-orientation": "vertical",
        "aria-valuemin": Math.log10(this.range[0]).toFixed(2), // decades: the axis is logarithmic
        "aria-valuemax": Math.log10(this.range[1]).toFixed(2),
        "aria-valuenow": Math.log10(this.tolerance).toFixed(2),
        "aria-valuetext": lengthOrAngle(this.tolerance),
        onpointerdown: (event) => this.drag(event),
        onkeydown: (event) => this.nudge(event),
      },
      svg("rect", { x: left, y: y - 9, width: width - this.right - left, height: 18, fill: "transparent" }),
      svg("line", { x1: left, x2: width - this.right, y1: y, y2: y }),
      svg("rect", { class: "grip", x: left + 6, y: y - 10, width: 118, height: 20, rx: 10 }),
      svg("text", { x: left + 65, y: y + 4, "text-anchor": "middle" }, `↕ within ${lengthOrAngle(this.tolerance)}`),
    );
    return grip;
  }

  drag(event) {
    event.preventDefault();
    const move = (e) => {
      const box = this.picture.getBoundingClientRect();
      const y = ((e.clientY - box.top) / box.height) * height;
      const share = (height - bottom - y) / (height - bottom - top);
      const [low, high] = this.range.map(Math.log10);
      const tenths = Math.round(10 * (low + Math.min(1, Math.max(0, share)) * (high - low)));
      this.pickTolerance(Number((10 ** (tenths / 10)).toPrecision(2)));
    };
    const stop = () => (window.removeEventListener("pointermove", move), window.removeEventListener("pointerup", stop));
    window.addEventListener("pointermove", move), window.addEventListener("pointerup", stop);
  }

  nudge(event) {
    const factor = { ArrowUp: 10 ** 0.1, ArrowDown: 10 ** -0.1, PageUp: 10, PageDown: 0.1 }[event.key];
    if (!factor) return;
    event.preventDefault(), event.stopPropagation();
    const next = Math.min(this.range[1], Math.max(this.range[0], this.tolerance * factor));
    this.pickTolerance(Number(next.toPrecision(2)));
    this.root.querySelector(".tolerance")?.focus();
  }

  tools() {
    const all = el(
      "button.quiet",
      {
        type: "button",
        "aria-expanded": String(this.withAll),
        onclick: () => ((this.withAll = !this.withAll), this.draw(this)),
      },
      this.withAll ? "only main runs" : `all ${this.curves.length} runs`,
    );
    return el(
      "p.figure-tools",
      {},
      el("span.fine", {}, this.isOneCase ? "✕ failed; dotted: adaptive reference." : "✕ over 1 case in 20 failed; hollow below the line: half of the cases are above it; dotted: adaptive reference."),
      el("span.spacer"),
      all,
      saveButtons("error-against-cost", () => this.picture, () => this.table()),
    );
  }

  table() {
    const cost = this.timed ? "cpu_seconds_per_second" : "steps_per_second";
    const rows = this.curves.flatMap((c) => c.points.map((p) => [c.engine, p.dt, p.cases, p.failed, p.mean, p.low, p.high, p.cost]));
    return [["run", "dt", "cases", "failed", "mean_error", "low_error", "high_error", cost], rows];
  }

  inWords(main) {
    const said = main.map((c) => {
      const finest = c.points.at(-1);
      return `${c.engine}: ${lengthOrAngle(finest.mean)} at ${finest.dt} s`;
    });
    return `Error against cost. ${said.join("; ")}.`;
  }
}
