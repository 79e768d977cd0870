// Names of runs, as everywhere in Rigor: core:METHOD,orientation=…,contact=…, or ENGINE.
import { nearestWord } from "./nearest.js";
import { outside } from "./simulators.js";

const isOutside = (name) => outside.some((one) => one.name === name);

// Every engine beside the core, wherever it runs.
const engines = new Set();
export function learnEngines(methods) {
  for (const { name, engine } of methods) if (engine) engines.add(name);
}

// The worker that a run needs (simulators.js).
export const kindOf = (name) => (isOutside(partsOf(name).method) ? partsOf(name).method : "core");

export function partsOf(name) {
  const [method, ...options] = name.replace(/^core:/, "").split(",");
  return { method, options: Object.fromEntries(options.map((one) => one.split("=", 2))) };
}

export function nameOf({ method, options }) {
  const texts = Object.entries(options)
    .filter(([, value]) => value)
    .map(([name, value]) => `${name}=${value}`);
  return [engines.has(method) ? method : `core:${method}`, ...texts].join(",");
}

export const shortName = (name) =>
  name
    .replace(/^core:/, "")
    .replaceAll("orientation=", "")
    .replaceAll("contact=", "");

// The run with what the core has; what it does not know is replaced by the nearest, and told.
export function fittingRun(name, methods, told) {
  const { method, options } = partsOf(name);
  let row = methods.find((one) => one.name === method);
  if (!row) {
    row = methods.find(
      (one) =>
        one.name ===
        nearestWord(
          method,
          methods.map((one) => one.name),
        ),
    );
    told.push(`There is no method “${method.slice(0, 60)}”; this is the nearest, “${row.name}”.`);
  }
  const fitting = {};
  for (const [key, value] of Object.entries(options)) {
    const option = row.options.find((one) => one.name === key);
    if (!option) told.push(`${row.name} has no option “${key.slice(0, 40)}”, so it is left out.`);
    else if (option.choices.includes(value)) fitting[key] = value;
    else {
      fitting[key] = nearestWord(value ?? "", option.choices);
      told.push(`${key} has no choice “${String(value).slice(0, 40)}”; this is the nearest, “${fitting[key]}”.`);
    }
  }
  return nameOf({ method: row.name, options: fitting });
}
