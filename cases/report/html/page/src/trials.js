// The trials of a recording: which one is played, and how the errors of all of them spread.
import { ink } from "./charts.js";
import { cellOf, median } from "./data.js";
import { add, el, svg } from "./dom.js";
import { digits, isNumber, quantity, words } from "./format.js";
import { saveButtons } from "./saving.js";
import { set, state } from "./state.js";

// The number of the trial that the address names, else of the first.
export const trialOf = (one) => Math.max(0, one.trials.indexOf(state.trial));

// A run's own errors, in the order of the file: the trial's name and the value of the case's main error.
const errorsOf = (one, cell) =>
  (cell?.trials ?? [])
    .map(({ trial, metrics }) => ({ trial, value: metrics[one.main] }))
    .filter(({ value }) => isNumber(value));

export const errorOfTrial = (one, cell, trial) =>
  errorsOf(one, cell).find((error) => error.trial === one.trials[trial])?.value ?? null;

// The trials at which the first run shown errs least, as usual, and most.
function notable({ one, dt, shown }) {
  const errors = shown.map((engine) => errorsOf(one, cellOf(one, engine.name, dt.text))).find((list) => list.length) ?? [];
  const sorted = errors.sort((a, b) => a.value - b.value);
  if (sorted.length < 3) return [];
  return [
    ["nearest", sorted[0].trial],
    ["median", sorted[Math.floor(sorted.length / 2)].trial],
    ["farthest", sorted.at(-1).trial],
  ];
}

export const nextTrial = (one, by) => set({ trial: one.trials[(trialOf(one) + by + one.trials.length) % one.trials.length] });

// A list of the trials, and the ways to the next ones and to notable ones. Null for a case without trials.
export function trialBar(context) {
  const { one } = context;
  if (!one.trials.length) return null;
  const step = (by, sign, title) =>
    el("button.quiet", { type: "button", title, "aria-label": title, onclick: () => nextTrial(one, by) }, sign);
  const first = context.shown.length ? context.shown[0].name : "";
  return el(
    "div.trials",
    { role: "group", "aria-label": "Trial" },
    el("span.fine", {}, "trial"),
    step(-1, "‹", "the trial before (,)"),
    el(
      "select",
      { "aria-label": "Trial played", onchange: (event) => set({ trial: event.target.value }) },
      one.trials.map((name, i) => el("option", { value: name, selected: i === trialOf(one) }, name)),
    ),
    step(1, "›", "the next trial (.)"),
    notable(context).map(([word, trial]) =>
      el("button.quiet", { type: "button", title: `where ${first} is ${word}: ${trial}`, onclick: () => set({ trial }) }, word),
    ),
  );
}

const frame = { width: 720, right: 96, top: 8, bottom: 40, row: 46 };

// Equal errors do not hide each other: the n-th dot stands a little above or below its row.
const spreadOut = (n, room) => (((n * 0.618034) % 1) - 0.5) * room;

function row({ results, one }, { engine, errors }, { x, y, left }) {
  const chosen = one.trials[trialOf(one)],
    middle = median(errors.map((error) => error.value));
  const told = (value) => quantity(value, results.units[one.main]);
  const dot = ({ trial, value }, n) =>
    svg(
      "circle",
      {
        cx: x(value).toFixed(1),
        cy: (trial === chosen ? y : y + spreadOut(n, frame.row - 18)).toFixed(1),
        r: trial === chosen ? 6 : 3,
        fill: ink(engine),
        opacity: trial === chosen ? 1 : 0.45,
        stroke: trial === chosen ? "var(--ink)" : "none",
        class: "pick",
        "data-trial": trial,
        onclick: () => set({ trial }),
      },
      svg("title", {}, `${engine.name}, trial ${trial}: ${told(value)}`),
    );
  // The chosen one is drawn last, above the others.
  const dots = errors.map(dot).sort((a, b) => a.getAttribute("r") - b.getAttribute("r"));
  return [
    svg("text", { x: left - 10, y: y + 4, "text-anchor": "end" }, engine.name),
    dots,
    svg("line", { class: "median", x1: x(middle), x2: x(middle), y1: y - 18, y2: y + 18, stroke: "var(--ink)", "stroke-width": 2 }),
    svg("text", { x: frame.width - frame.right + 8, y: y + 4, class: "strong" }, `median ${told(middle)}`),
  ];
}

// Each trial's error is a dot in the row of its run; a click plays it. Null where no run shown has trials.
export function trialSpread({ results, one, dt, shown }) {
  const lines = shown
    .map((engine) => ({ engine, errors: errorsOf(one, cellOf(one, engine.name, dt.text)) }))
    .filter(({ errors }) => errors.length);
  if (!lines.length) return null;
  const longest = Math.max(...lines.map(({ engine }) => engine.name.length), 10);
  const left = Math.min(300, 24 + 6.9 * longest),
    unit = results.units[one.main],
    label = `${words(one.main)} of each trial`,
    most = Math.max(...lines.flatMap(({ errors }) => errors.map((error) => error.value))) || 1,
    height = frame.top + frame.row * lines.length + frame.bottom,
    end = frame.width - frame.right;
  const x = (value) => left + (value / most) * (end - left);
  const root = svg("svg", { viewBox: `0 0 ${frame.width} ${height}`, class: "chart trial-spread", role: "img", "aria-label": label });
  for (let i = 0; i <= 4; ++i) {
    const value = (most * i) / 4;
    add(root, [
      svg("line", { class: "grid", x1: x(value), x2: x(value), y1: frame.top, y2: height - frame.bottom }),
      svg("text", { x: x(value), y: height - frame.bottom + 16, "text-anchor": "middle" }, digits(value, 2)),
    ]);
  }
  add(root, [svg("text", { class: "axis", x: (left + end) / 2, y: height - 6, "text-anchor": "middle" }, `${words(one.main)} [${unit}]`)]);
  lines.forEach((line, i) =>
    add(root, row({ results, one }, line, { x, y: frame.top + frame.row * (i + 0.5), left }).flat()),
  );
  const table = () => [
    ["run", "trial", `${words(one.main)} [${unit}]`],
    lines.flatMap(({ engine, errors }) => errors.map(({ trial, value }) => [engine.name, trial, value])),
  ];
  return el(
    "figure.wide",
    {},
    el("figcaption", {}, label, saveButtons("errors-of-trials", () => root, table)),
    el("div.scroll", { tabindex: 0 }, root),
  );
}
