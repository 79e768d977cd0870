// How much of an engine's error is its scheme's, as tables with a mark a part on a logarithmic line.
import { bounds, decades, ink } from "./charts.js";
import { cellOf, hasNumbers, signedMetric } from "./data.js";
import { el, svg, tableHead } from "./dom.js";
import { isNumber, percent, quantity, words } from "./format.js";

// For each run with a twin: the whole error, the scheme's part and the rest, on one logarithmic line.
export function schemeSplit({ results, one, dt }) {
  const rows = [
    ["position_error", "unexplained_error"],
    ["orientation_error", "unexplained_rotation"],
  ];
  const cells = results.engines
    .map((engine) => [engine, cellOf(one, engine.name, dt.text)])
    .filter(([, cell]) => cell?.by_scheme && hasNumbers(cell));
  if (!cells.length) return null;
  const size = (metrics, name) => (isNumber(metrics?.[name]?.value) ? metrics[name].value : null);
  const tables = rows.map(([total, rest]) => {
    const unit = results.units[total];
    const values = cells
      .map(([engine, cell]) => ({
        engine,
        total: size(cell.metrics, total),
        scheme: size(cell.by_scheme.metrics, total),
        rest: size(cell.metrics, rest),
        until: cell.metrics[rest]?.compared_until ?? one.duration,
      }))
      .filter((v) => v.total !== null && v.scheme !== null);
    if (!values.length || !values.some((v) => v.total > 1e-12)) return null;
    const range = bounds(values.flatMap((v) => [v.total, v.scheme, v.rest ?? 0]).map((v) => Math.max(v, 1e-17)));
    return el(
      "table.plain.split",
      {},
      el("caption", {}, words(total)),
      tableHead("run", "total", "by its scheme", "unexplained", ""),
      el(
        "tbody",
        {},
        values.map((v) =>
          el(
            "tr",
            {},
            el("th", { scope: "row" }, v.engine.name),
            el("td", {}, quantity(v.total, unit)),
            el("td", {}, quantity(v.scheme, unit)),
            el(
              "td",
              { title: isNumber(v.until) ? `compared until ${v.until.toFixed(2)} s` : "" },
              v.rest === null ? "–" : quantity(v.rest, unit),
            ),
            el("td.strip", {}, strip(v, range)),
          ),
        ),
      ),
    );
  });
  return el(
    "div.figures",
    {},
    [...tables, energySplit(cells)].filter(Boolean).map((table) => el("div.scroll", { tabindex: 0 }, table)),
  );
}

function strip({ engine, total, scheme, rest }, range) {
  const width = 240,
    x = decades(range[0], range[1], 8, width - 8);
  const mark = (value, shape) =>
    value === null ? null : svg("g", { transform: `translate(${x.at(Math.max(value, range[0]))} 10)` }, shape);
  return svg(
    "svg",
    {
      viewBox: `0 0 ${width} 20`,
      class: "chart",
      role: "img",
      "aria-label": "total, scheme and unexplained on a logarithmic line",
    },
    svg("line", { class: "grid", x1: 8, x2: width - 8, y1: 10, y2: 10 }),
    mark(
      total,
      svg("circle", { r: 6, fill: "none", stroke: ink(engine), "stroke-width": 2 }, svg("title", {}, "total")),
    ),
    mark(scheme, svg("circle", { r: 3, fill: ink(engine) }, svg("title", {}, "by its scheme"))),
    mark(
      rest,
      svg(
        "path",
        { d: "M-5,-5L5,5M-5,5L5,-5", stroke: "var(--bad)", "stroke-width": 2 },
        svg("title", {}, "unexplained"),
      ),
    ),
  );
}

// The energy over time: of the engine, of its scheme, and of the scheme without its gyroscopic term.
function energySplit(cells) {
  const name = "energy_drift";
  const rows = cells
    .map(([engine, cell]) => [
      engine,
      signedMetric(cell.metrics, name),
      signedMetric(cell.by_scheme.metrics, name),
      signedMetric(cell.by_scheme.without_gyroscopic_term, name),
    ])
    .filter(([, total]) => total !== null);
  if (!rows.some(([, total]) => Math.abs(total) > 1e-9)) return null;
  const sentence = (total, scheme, without) => {
    if (scheme === null || Math.abs(total) < 1e-9) return "";
    if (Math.abs(total - scheme) > 0.01 * Math.abs(total))
      return `its scheme explains ${percent(scheme / total)} of it`;
    if (without !== null && Math.abs(without) < 0.1 * Math.abs(total))
      return "all of it is the gyroscopic term of its scheme";
    return "all of it is its scheme";
  };
  return el(
    "table.plain.split",
    {},
    el("caption", {}, "energy, largest drift"),
    tableHead("run", "total", "by its scheme", "scheme without gyroscopic term", "where it goes"),
    el(
      "tbody",
      {},
      rows.map(([engine, total, scheme, without]) =>
        el(
          "tr",
          {},
          el("th", { scope: "row" }, engine.name),
          [total, scheme, without].map((v) => el("td", {}, v === null ? "–" : percent(v))),
          el("td.text", {}, sentence(total, scheme, without)),
        ),
      ),
    ),
  );
}
