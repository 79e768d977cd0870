// How to repair a run: the step or the engine to change to, the engine's own calls, and commands to paste.
import { judgement, cellOf } from "./data.js";
import { el } from "./dom.js";
import { cheapest, curvesOfCase, engineOf, isExternal, largestStep } from "./frontier.js";
import { lengthOrAngle } from "./frontier_chart.js";

export const copied = (text) =>
  el("button.quiet", { type: "button", onclick: () => navigator.clipboard?.writeText(text) }, "copy");

// The change of step or engine that this report has seen to work.
function advice({ results, one, dt }, run, tolerance) {
  const within = lengthOrAngle(tolerance),
    curves = curvesOfCase(results, one),
    curve = curves.find((c) => c.engine === run.name);
  const verdict = judgement(cellOf(one, run.name, dt.text));
  const point = curve && largestStep(curve, tolerance);
  if (point?.dt_seconds >= dt.seconds && verdict.kind !== "bad") return null; // nothing to repair
  if (point) return { dt: point.dt, text: `Take dt = ${point.dt} s: the error is then within ${within}.` };
  const other = cheapest(curves, tolerance, (c) => isExternal(c) && engineOf(c) !== engineOf({ engine: run.name }));
  const change = other ? `; ${other.curve.engine} at ${other.point.dt} s is` : "";
  return { dt: dt.text, text: `No step that was tried is within ${within}${change}. Look for a setting with rigor tune.` };
}

const isNamed = (one, run, setting) =>
  one.explanations.some((text) => text.includes(run.name) && text.includes(`"${setting}"`));

function rowOf(context, run, tolerance) {
  const { results, one } = context,
    found = advice(context, run, tolerance);
  if (!found) return null;
  const cell = cellOf(one, run.name, context.dt.text),
    named = Object.entries(cell?.settings ?? {}).filter(([setting]) => isNamed(one, run, setting)),
    calls = results.calls?.[run.name]?.[found.dt] ?? [];
  return el(
    "details.repair",
    {},
    el("summary", {}, el("b", {}, run.name), ` ${found.text}`),
    named.length ? el("p", {}, "The setting that “Why” names: ", named.map(([name, value]) => el("code", {}, `${name} = ${value}`))) : null,
    calls.length ? [el("p.fine", {}, "The engine's own calls for this run:"), el("pre", { tabindex: 0 }, el("code", {}, calls.join("\n"))), copied(calls.join("\n"))] : null,
  );
}

export function repairs(context, tolerance) {
  if (context.one.truth.kind === "none") return el("p.fine", {}, "No error is known here, so nothing can be said to reduce it.");
  if (context.one.truth.kind === "recording")
    return el("p.fine", {}, "The error is a mean over a recording. rigor fit finds the values of the scene and the settings with which an engine predicts it best.");
  const rows = context.shown.filter((run) => !run.core).map((run) => rowOf(context, run, tolerance)).filter(Boolean);
  return rows.length ? rows : el("p.fine", {}, "Nothing to repair: every engine shown is within the tolerance.");
}

export function commands({ one, dt, shown }, tolerance) {
  const first = (shown.find((e) => !e.core) ?? shown[0])?.name;
  const chosen = shown.map((e) => ` --engine '${e.name}'`).join("").replaceAll(/'([\w:@,=.-]+)'/g, "$1");
  const isComputed = !["none", "recording"].includes(one.truth.kind),
    isFriction = one.truth.kind === "recording" && one.scene.contact_default;
  const rows = [
    ["Run it again", `rigor run ${one.id} --dt ${dt.text}${chosen}`],
    first && isFriction ? ["Fit the friction", `rigor fit ${one.id} --engine ${first} --dt ${dt.text} --vary scene.contact_default.friction=0.02..0.6`] : null,
    first && isComputed ? ["Find the cheapest setting", `rigor tune ${one.id} --engine ${first.split(/[:@,]/)[0]} --within ${Number((1000 * tolerance).toPrecision(3))}mm`] : null,
    first ? [one.trials.length ? "Keep the first trial's motion" : "Keep its motion", `rigor trace ${one.id} --engine ${first} --dt ${dt.text} > run.csv`] : null,
  ].filter(Boolean);
  return el("dl.commands", {}, rows.map(([label, command]) => [el("dt", {}, label), el("dd", {}, el("code", {}, command), copied(command))]));
}
