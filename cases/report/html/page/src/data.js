// The results as the page uses them: cases with their cells, engines with their colours, and what follows from several
// cells. All of it is read from the report itself.
import { digits, isNumber, quantity } from "./format.js";

function inflating(base64) {
  const text = atob(base64),
    bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")));
}

export const unpacked = async (base64) => new Uint8Array(await inflating(base64).arrayBuffer());

export async function loadResults() {
  const packed = JSON.parse(document.getElementById("rigor-results").textContent);
  const results = await inflating(packed.data).json();
  const playback = JSON.parse(document.getElementById("rigor-playback").textContent);
  return indexed(results, playback);
}

// A row of packed_cells.h as the metric that results.json has, with its name.
function unpackedMetric(row, strings) {
  const rest = row.at(-1) !== null && typeof row.at(-1) === "object" ? row.at(-1) : null;
  const [name, value, time, body, component, found, expected] = rest ? row.slice(0, -1) : row;
  const metric = { value, ...rest };
  if (time !== undefined)
    metric.worst = {
      time,
      body: strings[body],
      component: strings[component],
      found: found === undefined ? value : found,
      expected: expected === undefined ? 0 : expected,
    };
  return [strings[name], metric];
}

// The cells as results.json has them. A page of a site has them already. The metrics of a cell are unpacked when they
// are first asked for, because the first screen shows a third of them.
function unpackCells(results) {
  const { strings, cell_settings: settings } = results;
  if (!strings) return;
  for (const cell of results.cells) {
    const rows = cell.metrics;
    Object.defineProperty(cell, "metrics", {
      configurable: true,
      get() {
        const value = Object.fromEntries(rows.map((row) => unpackedMetric(row, strings)));
        Object.defineProperty(cell, "metrics", { value });
        return value;
      },
    });
    cell.settings = settings[cell.settings];
  }
}

// Results of an older schema lack these.
function fillGaps(results) {
  for (const list of ["metrics", "findings", "frontier", "tolerances", "stable_dt", "relative_errors"]) results[list] ??= [];
  for (const one of results.cases) {
    for (const list of ["dt", "observed_order", "work_precision", "gates", "step_needed", "explanations"]) one[list] ??= [];
    one.truth ??= { kind: "none" };
  }
}

function indexed(results, playback) {
  fillGaps(results);
  unpackCells(results);
  results.units = Object.fromEntries(results.metrics.map((m) => [m.name, m.unit]));
  results.summaries = Object.fromEntries(results.metrics.map((m) => [m.name, m.summary]));
  results.series = playback.series;
  for (const engine of results.engines)
    Object.assign(engine, {
      core: engine.in_house === true,
      stock: engine.name.includes("@stock"),
      isSingle: engine.precision === "single",
    });
  results.engines = inReadingOrder(results);
  results.engines.forEach((engine, i) => (engine.index = i));
  giveColours(results.engines);
  results.caseById = new Map();
  results.cases.forEach((one, i) => {
    Object.assign(one, {
      index: i,
      cells: [],
      stable: new Map(),
      trials: [], // names; none for a truth without trials
      truthPlayback: playback.cases[i].truth,
      main: one.main_error ?? "position_error",
    });
    one.family = one.id.includes("/") ? one.id.slice(0, one.id.lastIndexOf("/")) : "";
    one.coarsest = one.dt.reduce((a, b) => (b.seconds > a.seconds ? b : a));
    results.caseById.set(one.id, one);
  });
  for (const cell of results.cells) {
    const one = results.caseById.get(cell.case);
    cell.playback = playback.cases[one.index].cells[one.cells.length];
    one.cells.push(cell);
    if (!one.trials.length) one.trials = (cell.trials ?? []).map(({ trial }) => trial);
  }
  for (const stable of results.stable_dt) results.caseById.get(stable.case).stable.set(stable.engine, stable);
  results.dts = distinctDts(results.cases);
  return results;
}

// Other engines come first, because readers look for them; runs that only some cases need come last.
function inReadingOrder({ engines, cells, cases }) {
  const casesOf = new Map(engines.map((e) => [e.name, new Set()]));
  for (const cell of cells) casesOf.get(cell.engine).add(cell.case);
  for (const e of engines) e.isRare = 2 * casesOf.get(e.name).size < cases.length;
  const place = (e) => (e.isRare ? 2 : e.core ? 1 : 0);
  return [...engines].sort((a, b) => place(a) - place(b));
}

// Engines that are not ours have the warm and the strong colours, lighter ones once all are taken; the stock track of one
// is its dashed twin. Settings of one engine have one colour, except where there are enough for all.
function giveColours(engines) {
  const strong = [
    [28, 0.17],
    [252, 0.16],
    [328, 0.19],
    [85, 0.15],
    [190, 0.12],
  ];
  const calm = [145, 290, 215, 60, 350, 110, 265, 170, 20, 310, 235, 130];
  const foreign = new Map(),
    withoutTrack = ({ name }) => name.split("@")[0],
    isEnough = new Set(engines.filter((e) => !e.core).map(withoutTrack)).size <= strong.length;
  let own = 0;
  for (const engine of engines) {
    let hue, chroma;
    if (engine.core) {
      (hue = calm[own % calm.length]), (chroma = 0.1 + 0.03 * (own % 2)), (engine.step = own++ % 3);
    } else {
      const family = isEnough ? withoutTrack(engine) : (engine.engine ?? engine.name);
      if (!foreign.has(family)) foreign.set(family, foreign.size);
      const place = foreign.get(family);
      ([hue, chroma] = strong[place % strong.length]), (engine.step = Math.floor(place / strong.length) % 3);
    }
    engine.colours = [
      `oklch(${0.55 + 0.07 * engine.step} ${chroma} ${hue})`,
      `oklch(${0.72 + 0.06 * engine.step} ${chroma} ${hue})`,
    ];
    engine.hex = [toHex(0.55 + 0.07 * engine.step, chroma, hue), toHex(0.72 + 0.06 * engine.step, chroma, hue)];
    engine.dash = engine.stock ? [5, 4] : null;
  }
}

// Oklch to sRGB, for canvases and WebGL (B. Ottosson, "A perceptual color space for image processing", 2020).
function toHex(lightness, chroma, hue) {
  const a = chroma * Math.cos((hue * Math.PI) / 180),
    b = chroma * Math.sin((hue * Math.PI) / 180);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const linear = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
  const byte = (v) => {
    const c = Math.min(1, Math.max(0, v));
    return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
  };
  return "#" + linear.map((v) => byte(v).toString(16).padStart(2, "0")).join("");
}

function distinctDts(cases) {
  const found = new Map();
  for (const one of cases) for (const dt of one.dt) found.set(dt.text, dt);
  return [...found.values()].sort((a, b) => b.seconds - a.seconds);
}

export const metricOf = (cell, name) => {
  const metric = cell?.metrics?.[name];
  return metric && isNumber(metric.value) ? metric.value : null;
};

// Of cases whose truth has no body that moves.
export const nothingMoves = (count) =>
  `Nothing moves in ${count === 1 ? "this case, so it tells" : "these cases, so they tell"} no step size`;

// Whether the truth is made by the run's own code: it tells how a method converges, not whether it is right.
export const isHeldToItself = (cell, name) => cell?.metrics?.[name]?.held_to_itself === true;
// What a truth that is a witness says.
export const witnessed = (cell, name) => (isHeldToItself(cell, name) ? null : metricOf(cell, name));

// The metric with its sign: lost energy is negative.
export function signedMetric(metrics, name) {
  const metric = metrics?.[name];
  if (!metric || !isNumber(metric.value)) return null;
  return metric.worst && metric.worst.found < metric.worst.expected ? -metric.value : metric.value;
}

export const cellOf = (one, engine, dtText) => one.cells.find((c) => c.engine === engine && c.dt === dtText);

// At the step asked for, else at the coarsest one of the case.
export function dtOf(one, dtText) {
  return one.dt.find((dt) => dt.text === dtText) ?? one.coarsest;
}

// The result of a cell: a word, a sign and a colour.
export function judgement(cell) {
  if (!cell) return { kind: "none", sign: "", word: "not run" };
  const failed = (cell.gates ?? []).filter((gate) => gate.answer === "failed").length;
  switch (cell.status) {
    case "unsupported":
      return { kind: "none", sign: "–", word: "unsupported" };
    case "diverged":
      return {
        kind: "bad",
        sign: "✕",
        word: cell.verdict?.phrase ?? "blown up",
      };
    case "known-deviation":
      return { kind: "known", sign: "◆", word: "known deviation" };
    case "unexpected-pass":
      return { kind: "drift", sign: "◇", word: "unexpected pass" };
    case "fail":
      return { kind: "bad", sign: "✕", word: failed > 1 ? `${failed} gates failed` : "gate failed" };
    case "pass":
      break;
    default:
      return { kind: "bad", sign: "!", word: cell.status.replace("-", " ") };
  }
  const word = cell.verdict?.phrase ?? "stable";
  const found = verdictKinds[cell.verdict?.word ?? "stable"];
  if (found.kind === "good" && cell.reduced_order) return { kind: "drift", sign: "◐", word: `${word} in part` };
  return { ...found, word: cell.sub_step ? `${word} ÷` : word };
}

// What a cell's verdict and numbers do not say.
export const warningOf = (cell) =>
  cell?.reduced_order ? `from ${digits(cell.reduced_order.from)} s on stepped ${cell.reduced_order.how}` : "";

// s: when the cell's motion blew up, collapsed or otherwise failed; null if it did not, or not at an instant.
// The verdict of several trials is the worst one's, which need not be the trial shown.
export function failedAt(cell) {
  if (cell?.trials) return null;
  const { word, time } = cell?.verdict ?? {};
  return ["blown up", "collapsed"].includes(word) && isNumber(time) ? time : null;
}

// Why a cell ended as it did, and what to know beside it; for where the mouse rests.
export const asideOf = (cell) => [cell.reason, warningOf(cell)].filter(Boolean).map((text) => ` – ${text}`).join("");

const verdictKinds = {
  stable: { kind: "good", sign: "✓" },
  drifting: { kind: "drift", sign: "≈" },
  overlapping: { kind: "bad", sign: "∩" },
  gaining: { kind: "bad", sign: "↑" },
  collapsed: { kind: "bad", sign: "↓" },
  tunnelled: { kind: "bad", sign: "»" },
};

// Whether a case's main error is a length or an angle, which a tolerance can be compared with. Not an energy, nor the mean
// error of a recording, which is in percent.
export const isAgainstTolerance = (one) => ["position_error", "orientation_error"].includes(one.main);

// A cell's error in decades of the tolerance, from 0 (a hundredth of it or less) to 5 (more than a hundred times it).
// Level 2 is still within. Null where there is no such error, or where the motion failed as a whole.
export function levelOf(one, cell, tolerance) {
  if (!cell || judgement(cell).kind === "bad") return null;
  const error = isAgainstTolerance(one) ? metricOf(cell, one.main) : null;
  if (error === null) return null;
  return Math.min(5, Math.max(0, Math.ceil(Math.log10(Math.max(error, 1e-300) / tolerance) - 1e-9) + 2));
}

export const hasNumbers = (cell) => cell && cell.status !== "diverged" && Object.keys(cell.metrics ?? {}).length > 0;

// Whether a cell's numbers are the engine's: not if it blew up or did not do what its method promises.
const cameToAResult = (cell) => ["pass", "fail", "known-deviation", "unexpected-pass"].includes(cell.status);

// Error against dt of one engine, coarse to fine.
export function errorPoints(one, engine, metric) {
  return one.cells
    .filter((c) => c.engine === engine && cameToAResult(c) && metricOf(c, metric) !== null)
    .map((c) => ({
      dt: c.dt,
      seconds: c.dt_seconds,
      error: metricOf(c, metric),
      cost: c.cpu_seconds / one.duration,
      cell: c,
    }))
    .sort((a, b) => b.seconds - a.seconds);
}

// The tolerance of results.json that is at or below the one asked for, or the smallest.
export const tabulated = (results, tolerance) =>
  (results.tolerances ?? []).filter((t) => t <= 1.001 * tolerance).at(-1) ?? results.tolerances?.[0] ?? tolerance;

// An entry of step_needed at a tolerance, in words. Null where there is none.
function stepText(results, row, tolerance) {
  const at = (results.tolerances ?? []).indexOf(tabulated(results, tolerance));
  if (!row || at < 0 || row.found[at] === undefined) return null;
  const mark = { coarsest: "≥ ", beyond: "~ " }[row.found[at]] ?? "";
  return isNumber(row.dt[at]) ? `${mark}${quantity(row.dt[at], "s")}` : "none";
}

// The largest step that keeps a run's main error within the tolerance in one case.
export const stepFor = (results, one, engine, tolerance) =>
  stepText(results, one.step_needed?.find((row) => row.engine === engine), tolerance);

// The largest stable step in words: at the largest or the smallest that was tried it is a bound.
export const stableText = (stable) =>
  `${stable.is_cap ? "≥ " : stable.is_floor ? "< " : ""}${quantity(stable.dt, "s")}`;

// An even count takes the larger of the two middle values, which is the worse error.
export function median(values) {
  if (!values.length) return null;
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.floor(sorted.length / 2)];
}
export const order = (one, engine, metric) =>
  one.observed_order.find((o) => o.engine === engine && o.metric === metric);
