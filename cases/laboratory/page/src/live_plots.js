// Energy, errors, orthonormality and gaps of joints over time, while the runs go on.
import uPlot from "uplot";
import { el, replace } from "../../../report/html/page/src/dom.js";
import { digits, quantity } from "../../../report/html/page/src/format.js";
import { linear, logarithmic } from "../../../report/html/page/src/plot_scales.js";
import { colour, isDark, onTheme } from "../../../report/html/page/src/theme.js";
import { colours, dashes } from "./colours.js";

const height = 150;
const mostPoints = 1200; // of a line: more are not to be seen
const tooSmall = 1e-12; // below it a plot shows only rounding

// `column`: of a reading (bench.js).
export const plots = [
  { name: "energy", title: "Energy", unit: "J", column: 1, isLog: false },
  { name: "position", title: "Distance from the truth", unit: "m", column: 3, isLog: true },
  { name: "orientation", title: "Angle from the truth", unit: "rad", column: 4, isLog: true },
  {
    name: "orthonormality",
    title: "|RᵀR − I|: how far the matrix is from a rotation",
    unit: "",
    column: 2,
    isLog: true,
  },
  { name: "gap", title: "Widest gap of a joint", unit: "m", column: 5, isLog: true },
];

export class LivePlots {
  constructor(root) {
    this.root = root;
    this.charts = [];
    onTheme(() => this.rebuild());
    new ResizeObserver(() => this.fit()).observe(root);
  }

  // `only`: names of plots; null: all with something to show.
  show(bench, { log, only = null }) {
    Object.assign(this, { bench, log, only });
    this.rebuild();
  }

  rebuild() {
    if (!this.bench) return;
    this.charts.forEach((one) => one.chart?.destroy());
    this.charts = plots.filter((plot) => !this.only || this.only.includes(plot.name)).map((plot) => this.figure(plot));
    replace(
      this.root,
      this.charts.map((one) => one.figure),
    );
    this.update();
  }

  figure(plot) {
    const readouts = el("div.readouts"),
      holder = el("div.plot-holder"),
      figure = el(
        "figure.plot",
        { "data-plot": plot.name },
        el("figcaption", {}, el("span", {}, plot.title), el("span.fine", {}, plot.unit), readouts),
        holder,
      );
    return { plot, figure, holder, readouts };
  }

  update() {
    for (const one of this.charts) this.draw(one);
  }

  // One table for all runs: they have the same steps.
  draw(one) {
    const { bench } = this,
      { plot } = one,
      courses = bench.runs.map((run) => bench.column(run, plot.column)),
      isLog = plot.isLog && this.log;
    const count = Math.max(0, ...courses.map((course) => course.length)),
      every = Math.max(1, Math.ceil(count / mostPoints)),
      times = [];
    for (let n = 0; n < count; n += every) times.push(n * bench.dt);
    const thin = courses.map((course) => times.map((_, i) => course[i * every] ?? NaN));
    const scale = isLog ? logarithmic(thin) : linear(plot.unit, tameRange(thin, bench));
    const data = [times, ...thin.map((values) => values.map((v) => (Number.isFinite(v) ? scale.put(v) : null)))];
    Object.assign(one, { scale, isLog });
    const width = Math.max(100, Math.floor(one.holder.clientWidth || this.root.clientWidth));
    if (!one.chart || one.count !== courses.length) {
      one.chart?.destroy();
      one.chart = new uPlot(this.options(one, courses.length, width), data, one.holder);
      one.count = courses.length;
    } else one.chart.setData(data);
    this.write(one, courses);
  }

  write({ plot, readouts, figure }, courses) {
    while (readouts.children.length > courses.length) readouts.lastChild.remove();
    while (readouts.children.length < courses.length) readouts.append(el("span", {}, el("i"), el("b")));
    courses.forEach((course, k) => {
      const value = course.at(Math.min(this.bench.done, course.length - 1)),
        [mark, text] = readouts.children[k].children;
      mark.className = `run-${k}`;
      text.textContent = Number.isFinite(value)
        ? plot.unit
          ? quantity(value, plot.unit)
          : quantity(value, "", 2)
        : "–";
    });
    const isEmpty = courses.every((course) => course.every((v) => !(Math.abs(v) > tooSmall)));
    figure.classList.toggle("is-empty", isEmpty && !this.only);
  }

  options(one, count, width) {
    const axis = {
      stroke: colour("--ink-2"),
      grid: { stroke: colour("--line"), width: 1 },
      ticks: { show: false },
      font: "11px system-ui, sans-serif",
    };
    const line = (_, k) => ({
      stroke: colours[k][isDark() ? 1 : 0],
      width: 1.8,
      dash: dashes[k] ?? undefined,
      spanGaps: false,
      points: { show: false },
    });
    return {
      ...{ width, height, legend: { show: false }, cursor: { show: false } },
      scales: {
        x: { time: false, range: () => [0, Math.max(this.bench.duration, 1e-6)] },
        y: { range: (u, low, high) => one.scale.range(u, low, high) },
      },
      axes: [
        { ...axis, size: 22, values: (u, ticks) => ticks.map((t) => `${Number(t.toPrecision(6))} s`) },
        {
          ...axis,
          size: 62,
          splits: (u, i, low, high, step) => one.scale.splits?.() ?? evenly(low, high, step),
          values: (u, ticks) => ticks.map(one.isLog ? one.scale.tick : (t) => `${digits(t, 5)} ${one.plot.unit}`),
        },
      ],
      series: [{}, ...Array.from({ length: count }, line)],
    };
  }

  fit() {
    for (const { chart, holder } of this.charts) {
      const width = Math.floor(holder.clientWidth);
      if (chart && width > 0 && width !== chart.width) chart.setSize({ width, height });
    }
  }
}

function evenly(low, high, step) {
  const size = step || 10 ** Math.floor(Math.log10(Math.max(high - low, 1e-12) / 2)),
    splits = [];
  for (let k = Math.ceil(low / size); k * size <= high && splits.length < 12; ++k) splits.push(k * size);
  return splits;
}

// Of the runs that did not blow up. One that did would make the others a line. Where all did, some times the energy in
// play shows how it began.
function tameRange(courses, { runs, truth }) {
  const hasBlownUp = (run) => run.cell?.verdict?.word === "blown up" || run.ended !== "",
    finite = courses.map((values) => values.filter(Number.isFinite)),
    tame = finite.filter((_, k) => !hasBlownUp(runs[k])).flat();
  if (!runs.some(hasBlownUp)) return null;
  const first = finite[0]?.[0] ?? 0,
    most = 12 * (truth?.kinetic || Math.abs(first) || 1);
  if (tame.length === 0) return [first - most / 6, first + most];
  const low = Math.min(...tame),
    high = Math.max(...tame),
    room = 0.6 * (high - low) || 0.1 * Math.abs(high) || 1;
  return [low - room, high + room];
}
