// The distances at which friction stops bodies that slide in several directions, each drawn at its place of rest. The
// friction of a cone is isotropic and gives an arc. A pyramid brakes harder along its diagonals and dents the arc.
import { ink, legend } from "./charts.js";
import { cellOf, metricOf } from "./data.js";
import { add, el, svg } from "./dom.js";
import { digits, percent, quantity } from "./format.js";
import { saveButtons } from "./saving.js";
import { up } from "./scene_model.js";

const metric = "friction_anisotropy";

export function frictionFan({ one, dt, shown }, data) {
  const measured = (engine) => metricOf(cellOf(one, engine.name, dt.text), metric);
  const engines = shown.filter((e) => measured(e) !== null && data.runs.get(e.name)?.motion);
  if (!engines.length || !data.truth?.motion) return null;
  const [u, v] = level(up(one.scene));
  const sliding = one.scene.bodies.map((_, i) => i).filter((i) => length(wayOf(data.truth.motion, i, u, v)) > 0);
  const turned = (i) => Math.atan2(...wayOf(data.truth.motion, i, u, v).toReversed());
  sliding.sort((a, b) => turned(a) - turned(b));
  const waysOf = (motion) => sliding.map((i) => wayOf(motion, i, u, v));
  const lines = engines.map((engine) => ({ engine, ways: waysOf(data.runs.get(engine.name).motion) }));
  const names = sliding.map((i) => one.scene.bodies[i].name),
    picture = drawn(waysOf(data.truth.motion), lines, names);
  const table = () => [["run", "body", "along [m]", "across [m]"], lines.flatMap(({ engine, ways }) => ways.map((way, i) => [engine.name, names[i], ...way]))];
  return el(
    "figure.wide",
    {},
    el("figcaption", {}, "where they stop, from a common start", saveButtons("friction-by-direction", () => picture, table)),
    picture,
    legend(engines.map((e) => [e, `spread ${percent(measured(e))}`])),
  );
}

// Two directions across `vertical`.
function level(vertical) {
  const along = vertical.map(Math.abs).indexOf(Math.min(...vertical.map(Math.abs)));
  const axis = [0, 1, 2].map((k) => (k === along ? 1 : 0) - vertical[along] * vertical[k]);
  const u = axis.map((a) => a / Math.hypot(...axis));
  const v = [0, 1, 2].map((k) => vertical[(k + 1) % 3] * u[(k + 2) % 3] - vertical[(k + 2) % 3] * u[(k + 1) % 3]);
  return [u, v];
}

const length = ([x, y]) => Math.hypot(x, y);

// From a body's first place to its last, along u and v.
function wayOf({ values, bodies, times }, body, u, v) {
  const last = 7 * ((times.length - 1) * bodies + body);
  const way = [0, 1, 2].map((k) => values[last + k] - values[7 * body + k]);
  return [u, v].map((axis) => axis.reduce((sum, a, k) => sum + a * way[k], 0));
}

function drawn(truth, lines, names) {
  const size = 340,
    margin = 34;
  const all = [[0, 0], ...truth, ...lines.flatMap((l) => l.ways)];
  const low = [0, 1].map((k) => Math.min(...all.map((p) => p[k]))),
    high = [0, 1].map((k) => Math.max(...all.map((p) => p[k])));
  const scale = (size - 2 * margin) / Math.max(high[0] - low[0], high[1] - low[1]);
  const at = ([x, y]) => [margin + scale * (x - low[0]), size - margin - scale * (y - low[1])];
  const path = (ways) => ways.map((p) => at(p).map((c) => c.toFixed(1)).join(",")).join(" ");
  const [x0, y0] = at([0, 0]),
    reach = Math.max(...truth.map(length));
  const root = svg("svg", {
    viewBox: `0 0 ${size} ${size}`,
    class: "chart directions",
    role: "img",
    "aria-label": "where bodies that slide in several directions stop",
  });
  add(root, [
    truth.map((p) => svg("line", { class: "grid", x1: x0, y1: y0, x2: at(p)[0], y2: at(p)[1] })),
    svg("polyline", { points: path(truth), fill: "none", stroke: "var(--truth)", "stroke-width": 7 }),
    svg("text", { x: x0, y: y0 + 16, "text-anchor": "middle" }, "start"),
    svg("text", { x: at([reach, 0])[0], y: y0 + 16, "text-anchor": "end" }, `truth: ${quantity(reach, "m")}`),
  ]);
  for (const { engine, ways } of lines) {
    add(root, [
      svg("polyline", {
        points: path(ways),
        fill: "none",
        stroke: ink(engine),
        "stroke-width": 1.6,
        "stroke-dasharray": engine.dash?.join(" "),
      }),
      ways.map((p, i) =>
        svg(
          "circle",
          { cx: at(p)[0], cy: at(p)[1], r: 2.6, fill: ink(engine) },
          svg("title", {}, `${engine.name}, ${names[i]}: ${digits(length(p))} m of ${digits(length(truth[i]))} m`),
        ),
      ),
    ]);
  }
  return root;
}
