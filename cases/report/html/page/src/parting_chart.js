// The gap of two runs over time on a logarithmic axis, and what each single step adds, in shares of the bound.
import { bounds, decades } from "./charts.js";
import { add, el, replace, svg } from "./dom.js";
import { digits, power } from "./format.js";
import { saveButtons } from "./saving.js";

const unseen = 1e-9; // a share that roundings alone reach
const height = 300,
  left = 58,
  right = 14,
  top = 24,
  bottom = 42;

// Round numbers between two, at most `most`.
function roundNumbers(from, to, most) {
  const rough = (to - from) / most,
    decade = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((n) => n * decade).find((n) => n >= rough * (1 - 1e-9));
  const ticks = [];
  for (let n = Math.ceil(from / step - 1e-9); n * step <= to * (1 + 1e-9); ++n) ticks.push(Number((n * step).toPrecision(12)));
  return ticks;
}

export class PartingChart {
  constructor(found, player) {
    Object.assign(this, { found, player, isWhole: !found.parting });
    // JSON has no infinity: null stands for it.
    this.steps = (found.injections?.steps ?? []).map((step) => ({ ...step, share: step.share ?? Infinity }));
    this.points = found.gap.time.map((time, i) => ({ time, share: found.gap.share[i] ?? Infinity }));
    this.holder = el("div.parting-holder", {});
    this.range = el("button.quiet", { type: "button", onclick: () => ((this.isWhole = !this.isWhole), this.draw()) });
    this.root = el("figure.parting", {}, this.caption(), this.holder, this.legend());
    this.size = new ResizeObserver(() => {
      if (Math.abs(this.holder.clientWidth - this.width) > 4) this.draw();
    });
    this.size.observe(this.holder);
    this.stop = player.onTick(() => this.moveHead());
    this.width = 0;
    this.draw();
  }
  close() {
    this.size.disconnect(), this.stop();
  }

  // Whether there is anything but zeros.
  static isWorthwhile = (found) => found.gap.time.length > 1 && (found.gap.share.some((share) => share !== 0) || found.injections?.steps.length > 0);

  caption() {
    const name = `${this.found.case.replaceAll(/[^\w.-]+/g, "-")}-parting`;
    return el(
      "figcaption",
      {},
      "The gap over time",
      this.found.parting && this.end(false) < this.found.compared ? this.range : null,
      saveButtons(name, () => this.picture, () => this.table()),
    );
  }

  legend() {
    const row = (kind, text) => el("li", {}, svg("svg", { class: `chart-key ${kind}`, viewBox: "0 0 20 8", "aria-hidden": "true" }, kind === "gap" ? svg("path", { d: "M0 4H20" }) : svg("circle", { cx: 10, cy: 4, r: 3 })), text);
    return el("ul.chart-legend", {}, row("gap", "gap of the body that is farthest apart"), this.steps.length ? row("one-step", "what one step adds to it by free motion until they part") : null);
  }

  table() {
    const rows = this.points.map(({ time, share }) => ["gap", time, share, ""]);
    return [["run", "time [s]", "share of the bound", "body"], [...rows, ...this.steps.map((s) => ["one step", s.time, s.share, s.body])]];
  }

  // The plot ends a good way after the parting, so that an early one is seen.
  end(isWhole) {
    const { parting, compared } = this.found;
    return isWhole || !parting?.time ? compared : Math.min(compared, 1.6 * parting.time);
  }

  draw() {
    const { parting } = this.found;
    this.width = Math.min(1100, Math.max(300, this.holder.clientWidth || 700));
    this.range.textContent = this.isWhole ? "only until they part" : "whole time";
    const end = this.end(this.isWhole);
    this.shown = this.points.filter((p) => p.time <= end * (1 + 1e-9));
    const dots = this.steps.filter((s) => s.time <= end);
    const finite = [1, ...[...this.shown, ...dots].map((p) => p.share).filter((share) => share > unseen && share < Infinity)];
    const [low, high] = bounds(finite);
    this.x = (time) => left + (time / end) * (this.width - left - right);
    this.timeAt = (x) => ((x - left) / (this.width - left - right)) * end;
    this.y = decades(low, high, height - bottom, top);
    this.y.floor = low;
    const words = parting ? `It reaches the bound at ${digits(parting.time, 4)} s.` : `It is at most ${digits(this.found.largest_share)} of the bound.`;
    const picture = svg("svg", {
      viewBox: `0 0 ${this.width} ${height}`,
      class: "chart parting-chart",
      role: "img",
      "aria-label": `The gap in shares of the bound, over time. ${words}`,
      onpointerdown: (event) => this.seek(event),
    });
    add(picture, [this.axes(end), this.line(), dots.map((s) => this.dot(s)), this.marks(end)]);
    this.picture = picture;
    replace(this.holder, picture);
    this.moveHead();
  }

  axes(end) {
    const isBelow = [...this.shown, ...this.steps].some((p) => !(p.share >= this.y.floor));
    return [
      roundNumbers(0, end, this.width < 500 ? 4 : 8).map((time) => [
        svg("line", { class: "grid", x1: this.x(time), x2: this.x(time), y1: top, y2: height - bottom }),
        svg("text", { x: this.x(time), y: height - bottom + 16, "text-anchor": "middle" }, digits(time, 6)),
      ]),
      this.y.ticks.map(([value, text], i) => [
        svg("line", { class: "grid", x1: left, x2: this.width - right, y1: this.y.at(value), y2: this.y.at(value) }),
        svg("text", { x: left - 6, y: this.y.at(value) + 4, "text-anchor": "end" }, i === 0 && isBelow ? `≤ 10${power(Math.round(Math.log10(value)))}` : text),
      ]),
      svg("text", { class: "axis", x: (left + this.width - right) / 2, y: height - 6, "text-anchor": "middle" }, "time [s]"),
      svg("text", { class: "axis", x: 12, y: height / 2, transform: `rotate(-90 12 ${height / 2})`, "text-anchor": "middle" }, "share of the bound"),
    ];
  }

  line() {
    const places = this.shown.map((p) => `${this.x(p.time).toFixed(1)},${this.y.at(Math.min(p.share, 1e300)).toFixed(1)}`);
    return svg("polyline", { class: "gap", points: places.join(" ") });
  }

  dot(step) {
    return svg(
      "circle",
      { class: "one-step", cx: this.x(step.time).toFixed(1), cy: this.y.at(Math.min(step.share, 1e300)).toFixed(1), r: this.width < 500 ? 1.8 : 2.6 },
      svg("title", {}, `the step from ${digits(step.time, 5)} s on adds ${digits(step.share)} of the bound until they part, most to “${step.body}”`),
    );
  }

  // The bound, the instant of the parting, and the time of the playback.
  marks(end) {
    const { parting } = this.found,
      y1 = top,
      y2 = height - bottom;
    this.head = svg("line", { class: "head", y1, y2 });
    const marks = [
      svg("line", { class: "bound", x1: left, x2: this.width - right, y1: this.y.at(1), y2: this.y.at(1) }),
      svg("text", { class: "strong", x: left + 6, y: this.y.at(1) - 5 }, "bound"),
      this.head,
    ];
    if (!parting) return marks;
    const x = this.x(parting.time),
      isRight = parting.time > 0.6 * end;
    return [
      ...marks,
      svg("line", { class: "parts-at", x1: x, x2: x, y1, y2 }),
      svg("text", { class: "strong parts-text", x: x + (isRight ? -5 : 5), y: top - 8, "text-anchor": isRight ? "end" : "start" }, `they part at ${digits(parting.time, 4)} s`),
    ];
  }

  seek(event) {
    const box = this.picture.getBoundingClientRect(),
      x = ((event.clientX - box.left) / box.width) * this.width;
    if (x >= left) this.player.seek(Math.min(this.timeAt(x), this.end(this.isWhole)));
  }

  moveHead() {
    const { time } = this.player,
      isShown = time <= this.end(this.isWhole) * (1 + 1e-9);
    this.head.setAttribute("visibility", isShown ? "visible" : "hidden");
    for (const key of ["x1", "x2"]) this.head.setAttribute(key, isShown ? this.x(time) : left);
  }
}
