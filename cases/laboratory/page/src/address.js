// What is looked at, as one object, and the same in the address behind the "#": a link shows the same to somebody else.
// Words that are not there and numbers out of range become the nearest that are; `told` says so.
import { nearest, nearestWord } from "./nearest.js";

export const steps = [10, 12, 15, 20, 24, 30, 40, 50, 60, 80, 100, 120, 150, 200, 240, 300, 400, 500, 600, 800, 1000];
export const speeds = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];
export const mostRuns = 4;

export const defaults = {
  case: "springs/fixed-spring",
  runs: ["core:explicit-euler", "core:semi-implicit-euler", "core:rk4"],
  dt: 30, // 1/dt in 1/s
  knobs: {}, // by name, those that differ from the case's own
  layout: "overlay",
  truth: true,
  log: true,
  speed: 1,
  at: 0, // steps made
  lesson: "", // "explicit-euler.2": its name and screen, from 1
};

export const dtText = (state) => `1/${state.dt}`;

export function addressOf(state, hasOwnText = false) {
  const query = new URLSearchParams();
  query.set("runs", state.runs.join("~"));
  query.set("dt", dtText(state));
  for (const [name, value] of Object.entries(state.knobs)) query.set(name, value);
  if (state.layout !== defaults.layout) query.set("layout", state.layout);
  if (!state.truth) query.set("truth", "0");
  if (!state.log) query.set("log", "0");
  if (state.speed !== 1) query.set("speed", state.speed);
  if (state.at > 0) query.set("at", state.at);
  if (state.lesson) query.set("lesson", state.lesson);
  const text = query.toString().replace(/%2F/g, "/").replace(/%3A/g, ":").replace(/%2C/g, ",").replace(/%3D/g, "=");
  return `#/${hasOwnText ? "own-file" : state.case}?${text}`;
}

// Parts of the address that need no scene. `cases`: the ids there are.
export function stateOf(hash, cases, told) {
  const [path, query = ""] = hash.replace(/^#\/?/, "").split("?");
  const given = new URLSearchParams(query);
  const state = { ...defaults, knobs: {}, runs: [...defaults.runs] };
  state.case = caseOf(path, cases, told);
  if (given.has("runs")) {
    const names = given.get("runs").split("~").filter(Boolean);
    state.runs = names.slice(0, mostRuns);
    if (names.length > mostRuns)
      told.push(`The address names ${names.length} methods; the first ${mostRuns} are shown.`);
  }
  if (given.has("dt")) state.dt = stepOf(given.get("dt"), told);
  if (given.has("speed")) state.speed = nearestOf("speed", Number(given.get("speed")), speeds, told);
  state.layout = given.get("layout") === "side" ? "side" : "overlay";
  state.truth = given.get("truth") !== "0";
  state.log = given.get("log") !== "0";
  state.lesson = given.get("lesson") ?? "";
  const at = Number(given.get("at") ?? 0);
  state.at = Number.isInteger(at) && at >= 0 ? at : 0;
  const known = ["runs", "dt", "speed", "layout", "truth", "log", "lesson", "at"];
  for (const [name, text] of given)
    if (!known.includes(name)) state.knobs[name] = text === "infinite" ? text : Number(text);
  return state;
}

function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

function caseOf(path, cases, told) {
  const id = decoded(path);
  if (!id) return defaults.case;
  if (cases.includes(id)) return id;
  if (id === "own-file") {
    told.push("A link cannot carry a file of your own. Drop the file again; until then this is the first scene.");
    return defaults.case;
  }
  const near = nearestWord(id, cases) ?? defaults.case;
  told.push(`There is no scene “${id}”; this is the nearest, “${near}”.`);
  return near;
}

function stepOf(text, told) {
  const [above, below = "1"] = text.split("/").map(Number);
  return nearestOf("dt", Number(below) / above, steps, told, (n) => `1/${n} s`);
}

// A number of a list: the nearest by ratio.
export function nearestOf(name, value, list, told, write = String) {
  if (list.includes(value)) return value;
  const isNumber = Number.isFinite(value) && value > 0;
  const near = isNumber ? nearest(value, list) : name === "dt" ? defaults.dt : 1;
  told.push(`${name} of the address is not one of the steps of its slider; it is now ${write(near)}.`);
  return near;
}

// The knobs of the scene that is shown, as far as it has them, in their ranges.
export function fittingKnobs(wanted, knobs, told) {
  const fitting = {};
  for (const [name, value] of Object.entries(wanted)) {
    const knob = knobs.find((one) => one.name === name);
    if (!knob) {
      told.push(`This scene has no “${name}”, so the address's value is left out.`);
    } else if (value === "infinite" && knob.infinite) {
      fitting[name] = value;
    } else if (!Number.isFinite(value)) {
      told.push(`${knob.label}: the address has no number; the scene's own value is used.`);
    } else {
      const within = Math.min(knob.most, Math.max(knob.least, value));
      if (within !== value) told.push(`${knob.label}: ${value} is out of range; it is now ${within}.`);
      fitting[name] = within;
    }
    if (fitting[name] === knob?.value) delete fitting[name];
  }
  return fitting;
}
