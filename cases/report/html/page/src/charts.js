// Figures over the cells of a case, as SVG: they print, scale and carry their text.
import { cellOf, errorPoints, judgement, order, stableText } from "./data.js";
import { add, el, svg } from "./dom.js";
import { digits, isNumber, power, quantity, words } from "./format.js";
import { saveButtons } from "./saving.js";
import { set } from "./state.js";

export const ink = (engine) => `var(--e${engine.index})`;

// Positions on a logarithmic axis; zero is placed at `from`.
export function decades(from, to, start, end) {
  const low = Math.log10(from),
    high = Math.log10(to);
  const at = (value) => start + ((Math.log10(Math.max(value, from)) - low) / (high - low || 1)) * (end - start);
  const ticks = [];
  const step = Math.max(1, Math.ceil((high - low) / 6));
  for (let e = Math.ceil(low - 1e-9); e <= high + 1e-9; e += step) ticks.push([10 ** e, `10${power(e)}`]);
  return { at, ticks };
}

export const bounds = (values) => {
  const positive = values.filter((v) => v > 0 && isNumber(v));
  if (!positive.length) return [1e-3, 1];
  return [
    10 ** Math.floor(Math.log10(Math.min(...positive)) - 0.01),
    10 ** Math.ceil(Math.log10(Math.max(...positive)) + 0.01),
  ];
};

// Reference lines of these orders from the coarsest step down, to compare the slopes of the lines.
function slopes(x, y, [finest, coarsest], [least, most]) {
  return [1, 2, 4].flatMap((order) => {
    const end = Math.max(finest, coarsest * (least / most) ** (1 / order)),
      low = most * (end / coarsest) ** order;
    return [
      svg("line", { class: "guide", x1: x.at(coarsest), x2: x.at(end), y1: y.at(most), y2: y.at(low) }),
      svg("text", { class: "guide", x: x.at(end) + 4, y: y.at(low) - 4 }, `order ${order}`),
    ];
  });
}

const logLogFrame = { width: 560, height: 340, left: 62, right: 12, top: 12, bottom: 44 };

// The grid, the ticks and the titles of two logarithmic axes.
function logLogAxes(x, y, { xLabel, yLabel, xTicks, zeroUpTo }) {
  const { width, height, left, right, top, bottom } = logLogFrame;
  return [
    (xTicks ?? x.ticks).map(([value, text]) => [
      svg("line", { class: "grid", x1: x.at(value), x2: x.at(value), y1: top, y2: height - bottom }),
      svg("text", { x: x.at(value), y: height - bottom + 16, "text-anchor": "middle" }, text),
    ]),
    y.ticks.map(([value, text]) => [
      svg("line", { class: "grid", x1: left, x2: width - right, y1: y.at(value), y2: y.at(value) }),
      svg("text", { x: left - 6, y: y.at(value) + 4, "text-anchor": "end" }, value <= zeroUpTo ? "0" : text),
    ]),
    svg("text", { class: "axis", x: (left + width - right) / 2, y: height - 6, "text-anchor": "middle" }, xLabel),
    svg(
      "text",
      { class: "axis", x: 14, y: height / 2, transform: `rotate(-90 14 ${height / 2})`, "text-anchor": "middle" },
      yLabel,
    ),
  ].flat(2);
}

function logLogLine(x, y, { engine, points }) {
  const places = points.map((p) => `${x.at(p.x).toFixed(1)},${y.at(p.y).toFixed(1)}`).join(" ");
  return [
    svg("polyline", {
      points: places,
      fill: "none",
      stroke: ink(engine),
      "stroke-width": 1.6,
      "stroke-dasharray": engine.dash?.join(" "),
    }),
    points.map((p) =>
      svg(
        "circle",
        { cx: x.at(p.x), cy: y.at(p.y), r: 4, fill: ink(engine), class: "pick", onclick: () => set({ dt: p.dt }) },
        svg("title", {}, `${engine.name}, dt = ${p.dt} s: ${p.text}`),
      ),
    ),
  ];
}

// Lines through points (x, y) on two logarithmic axes.
function logLog(lines, { xLabel, yLabel, xTicks, label, withSlopes }) {
  const { width, height, left, right, top, bottom } = logLogFrame;
  const xs = bounds(lines.flatMap((l) => l.points.map((p) => p.x))),
    ys = bounds(lines.flatMap((l) => l.points.map((p) => p.y)));
  if (xTicks)
    (xs[0] = Math.min(...xTicks.map((t) => t[0])) / 1.4), (xs[1] = Math.max(...xTicks.map((t) => t[0])) * 1.4);
  const floor = lines.some((l) => l.points.some((p) => !(p.y > 0))) ? ys[0] / 10 : ys[0];
  const x = decades(xs[0], xs[1], left, width - right),
    y = decades(floor, ys[1], height - bottom, top);
  const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "chart", role: "img", "aria-label": label });
  add(root, logLogAxes(x, y, { xLabel, yLabel, xTicks, zeroUpTo: floor < ys[0] ? floor * 1.01 : 0 }));
  if (withSlopes) add(root, slopes(x, y, [xTicks.at(-1)[0], xTicks[0][0]], [floor, ys[1]]));
  for (const line of lines) add(root, logLogLine(x, y, line));
  return root;
}

export const legend = (rows) =>
  el(
    "ul.chart-legend",
    {},
    rows.map(([engine, text]) =>
      el(
        "li",
        {},
        el("span.swatch", { class: engine.stock ? "swatch is-stock" : "swatch", style: { "--engine": ink(engine) } }),
        el("span", {}, engine.name),
        el("b", {}, text),
      ),
    ),
  );

const errorsOf = (one) => [...new Set(one.observed_order.map((o) => o.metric))];

// One figure for each kind of error, with one line for each shown engine. `place` returns a cell's x position and
// label, or nothing if it has none.
function errorFigures({ results, one, shown }, { place, axis, versus, below }) {
  const figures = errorsOf(one)
    .map((metric) => {
      const unit = results.units[metric];
      const pointsOf = (engine) =>
        errorPoints(one, engine.name, metric)
          .map((p) => ({ ...place(p, quantity(p.error, unit)), y: p.error, dt: p.dt }))
          .filter((p) => p.x > 0);
      const lines = shown.map((engine) => ({ engine, points: pointsOf(engine) })).filter((l) => l.points.length);
      if (!lines.length) return null;
      const picture = logLog(lines, { ...axis, yLabel: `${words(metric)} [${unit}]`, label: `${words(metric)} against ${versus}` });
      const head = ["run", "dt", axis.xLabel, `${words(metric)} [${unit}]`];
      const rows = lines.flatMap(({ engine, points: all }) => all.map((p) => [engine.name, p.dt, p.x, p.y]));
      return el(
        "figure.wide",
        {},
        el("figcaption", {}, words(metric), saveButtons(`${words(metric)} against ${versus}`.replaceAll(" ", "-"), () => picture, () => [head, rows])),
        picture,
        below(metric, lines),
      );
    })
    .filter(Boolean);
  return figures.length ? el("div.figures", {}, figures) : null;
}

export function convergence(context) {
  const { one } = context;
  if (one.dt.length < 2) return null;
  const fitted = (engine, metric) => {
    const found = order(one, engine.name, metric);
    return isNumber(found?.value) ? `order ${digits(Math.round(100 * found.value) / 100)}` : "no order";
  };
  return errorFigures(context, {
    place: (p, error) => ({ x: p.seconds, text: error }),
    axis: {
      xLabel: "dt [s]",
      xTicks: one.dt.map((dt) => [dt.seconds, dt.text]).sort((a, b) => b[0] - a[0]),
      withSlopes: true,
    },
    versus: "step size",
    below: (metric, lines) => legend(lines.map(({ engine }) => [engine, fitted(engine, metric)])),
  });
}

export function workPrecision(context) {
  const { one } = context;
  const bestOfCore = (metric) =>
    (one.work_precision.find((w) => w.metric === metric)?.best_of_core ?? []).filter((b) => b.times_less);
  return errorFigures(context, {
    place: (p, error) => ({ x: p.cost, text: `${error} for ${quantity(p.cost, "s")} of CPU a second` }),
    axis: { xLabel: "CPU time per simulated second [s/s]" },
    versus: "CPU time",
    below: (metric) =>
      bestOfCore(metric).map((b) =>
        el(
          "p.fine",
          {},
          `At the cost of ${b.baseline}, ${b.engine} errs ${digits(b.times_less, 2)} times less (${b.cells_compared} of ${b.cells} step sizes compared).`,
        ),
      ),
  });
}

// The runs of an engine in this case, each a mark at its step.
const stabilityMarks = (one, engine, x, middle) =>
  one.cells
    .filter((c) => c.engine === engine.name)
    .map((cell) => {
      const verdict = judgement(cell);
      return svg(
        "g",
        { class: `dot is-${verdict.kind}`, transform: `translate(${x.at(cell.dt_seconds)} ${middle})` },
        svg("circle", { r: 6.5 }),
        svg("text", { y: 3.5, "text-anchor": "middle" }, verdict.sign),
        svg("title", {}, `${engine.name}, dt = ${cell.dt} s: ${verdict.word}`),
      );
    });

function stabilityRow(one, engine, { x, left, y, height, isShown }) {
  const stable = one.stable.get(engine.name),
    middle = y + height / 2,
    known = isNumber(stable.dt),
    end = known ? x.at(stable.dt) : left,
    hasBar = known && !stable.is_floor;
  const text = known ? stableText(stable) : stable.status === "unsupported" ? "" : stable.status;
  const bar = { x: left, y: y + 4, width: Math.max(0, end - left), height: height - 8, rx: 3, fill: ink(engine), opacity: 0.3 };
  return [
    svg("text", { x: left - 10, y: middle + 4, "text-anchor": "end", class: isShown ? "strong" : "" }, engine.name),
    hasBar ? svg("rect", bar) : null,
    hasBar && !stable.is_cap
      ? svg("line", { x1: end, x2: end, y1: y + 2, y2: y + height - 2, stroke: ink(engine), "stroke-width": 2.5 })
      : null,
    svg(
      "text",
      { x: Math.max(end, left) + 8, y: middle + 4, class: "strong" },
      text,
      svg("title", {}, stable.reason || ""),
    ),
    stabilityMarks(one, engine, x, middle),
  ];
}

// A bar an engine, up to its largest stable dt; on it the runs there were.
export function stabilityMap({ one, shown, results }) {
  const engines = results.engines.filter(
    (e) => one.stable.get(e.name) && (shown.includes(e) || cellOf(one, e.name, one.coarsest.text)),
  );
  const known = engines.map((e) => one.stable.get(e.name).dt).filter(isNumber);
  const all = [...known, ...one.dt.map((dt) => dt.seconds), 1 / 30].filter((v) => v > 0);
  const longest = Math.max(...engines.map((e) => e.name.length), 10);
  const left = Math.min(420, 24 + 6.9 * longest),
    right = 110,
    width = 650 + left,
    row = 22,
    top = 26,
    height = top + row * engines.length + 12;
  const x = decades(Math.min(...all) / 2, Math.max(...all) * 1.6, left, width - right);
  const label = "Largest stable step of each engine";
  const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "chart stability", role: "img", "aria-label": label });
  for (const dt of one.dt) {
    add(root, [
      svg("line", { class: "grid", x1: x.at(dt.seconds), x2: x.at(dt.seconds), y1: top - 6, y2: height - 8 }),
      svg("text", { x: x.at(dt.seconds), y: 14, "text-anchor": "middle" }, dt.text),
    ]);
  }
  engines.forEach((engine, i) =>
    add(root, stabilityRow(one, engine, { x, left, y: top + i * row, height: row, isShown: shown.includes(engine) })),
  );
  const reasons = new Set(engines.map((e) => one.stable.get(e.name)).filter((s) => !isNumber(s.dt)).map((s) => s.reason));
  const rows = engines.map((e) => [e.name, one.stable.get(e.name).dt, one.stable.get(e.name).status]);
  return [
    saveButtons("largest-stable-step", () => root, () => [["run", "largest stable dt [s]", "status"], rows]),
    el("div.scroll", { tabindex: 0 }, root),
    [...reasons].filter(Boolean).map((reason) => el("p.fine", {}, `No largest dt: ${reason}.`)),
  ];
}
