// A plot over time as an SVG file, from the same lines and scales as on the screen.
import { el, svg } from "./dom.js";
import { colour, isDark } from "./theme.js";

const width = 720,
  height = 300,
  left = 70,
  right = 150,
  top = 16,
  bottom = 36;

// `lines`: [engine or null for the truth, {times, values}]; `chart`: the uPlot that shows them.
export function timePicture({ name, lines, unit, scale, chart }) {
  const { x, y } = chart.scales;
  const across = (t) => left + ((t - x.min) / (x.max - x.min)) * (width - left - right),
    upwards = (v) => height - bottom - ((v - y.min) / (y.max - y.min)) * (height - top - bottom);
  const ink = colour("--ink"),
    grid = colour("--line");
  const ticks = (axis) => chart.axes[axis]._splits ?? [];
  const path = ({ times, values }) => {
    let text = "";
    times.forEach((t, i) => {
      const v = scale.put(values[i]);
      if (v === null || t < x.min || t > x.max) return;
      text += `${text ? "L" : "M"}${across(t).toFixed(1)} ${Math.max(top, Math.min(height - bottom, upwards(v))).toFixed(1)}`;
    });
    return text;
  };
  const label = (attributes, text) => svg("text", { fill: ink, "font-family": "system-ui, sans-serif", "font-size": 12, ...attributes }, text);
  const picture = svg(
    "svg",
    { xmlns: "http://www.w3.org/2000/svg", viewBox: `0 0 ${width} ${height}`, width, height },
    svg("rect", { width, height, fill: colour("--paper") }),
    ticks(0).map((t) => [
      svg("path", { d: `M${across(t)} ${top}V${height - bottom}`, stroke: grid }),
      label({ x: across(t), y: height - bottom + 16, "text-anchor": "middle" }, `${Number(t.toPrecision(6))} s`),
    ]),
    ticks(1).map((v) => [
      svg("path", { d: `M${left} ${upwards(v)}H${width - right}`, stroke: grid }),
      label({ x: left - 6, y: upwards(v) + 4, "text-anchor": "end" }, scale.tick(v)),
    ]),
    lines.map(([engine, course], i) => {
      const stroke = engine ? engine.hex[isDark() ? 1 : 0] : colour("--truth-solid");
      return [
        svg("path", { d: path(course), fill: "none", stroke, "stroke-width": engine ? 1.5 : 3.5, "stroke-dasharray": engine?.dash?.join(" ") }),
        label({ x: width - right + 10, y: top + 12 + 16 * i, fill: stroke }, engine?.name ?? "truth"),
      ];
    }),
    label({ x: left, y: 12 }, `${name.replaceAll("_", " ")}${unit && unit !== "1" ? ` [${unit}]` : ""}`),
  );
  return el("div", {}, picture).innerHTML;
}

export const timeTable = ({ name, lines, unit }) => [
  ["run", "time [s]", unit && unit !== "1" ? `${name} [${unit}]` : name],
  lines.flatMap(([engine, course]) => [...course.times].map((t, i) => [engine?.name ?? "truth", t, course.values[i]])),
];
