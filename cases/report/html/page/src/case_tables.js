// The tables of a case: numbers at one step, gates, settings, the file itself.
import {
  cellOf,
  hasNumbers,
  isHeldToItself,
  judgement,
  metricOf,
  signedMetric,
  stableText,
  stepFor,
  warningOf,
} from "./data.js";
import { el, tableHead } from "./dom.js";
import { digits, isNumber, percent, quantity, singleTitle, words } from "./format.js";

const usual = [
  "position_error",
  "orientation_error",
  "energy_drift",
  "energy_drift_synchronised",
  "angular_momentum_drift",
  "linear_momentum_drift",
  "joint_gap",
];

const stepForTitle =
  "the largest step that keeps the main error within this tolerance; ≥ at the coarsest step already, ~ extrapolated below the finest";

export function numbersTable({ results, one, dt }) {
  const rows = results.engines.map((engine) => [engine, cellOf(one, engine.name, dt.text)]).filter(([, cell]) => cell);
  const present = results.metrics
    .map((m) => m.name)
    .filter((name) => rows.some(([, cell]) => metricOf(cell, name) !== null));
  const names = [...usual.filter((name) => present.includes(name)), ...present.filter((name) => !usual.includes(name))];
  const shown = (cell, name) => {
    const unit = results.units[name],
      metric = cell.metrics?.[name];
    if (!metric) return el("td", {}, "–");
    if (metric.not_applicable !== undefined) return el("td.none", { title: metric.not_applicable }, "–");
    const text =
      unit === "1" && name.startsWith("energy")
        ? percent(signedMetric(cell.metrics, name))
        : quantity(metric.value, unit);
    const w = metric.worst;
    return el(
      "td",
      {
        title: w
          ? `${isHeldToItself(cell, name) ? "held to a truth that its own code makes; " : ""}worst at ${digits(w.time)} s: ${w.body}, ${w.component}: found ${digits(w.found, 6)}, expected ${digits(w.expected, 6)}`
          : "",
      },
      isHeldToItself(cell, name) ? `(${text})` : text,
    );
  };
  const stable = (engine) => {
    const found = one.stable.get(engine.name);
    return found && isNumber(found.dt) ? stableText(found) : "–";
  };
  const millimetre = (engine) => {
    if (one.main === "energy_drift_synchronised") return "–";
    return stepFor(results, one, engine.name, 1e-3) ?? "–";
  };
  const warnings = rows
    .filter(([, cell]) => cell.reduced_order)
    .map(([engine, cell]) => el("li", {}, `${engine.name} is ${warningOf(cell)}`));
  return [
    warnings.length ? el("ul.findings.warnings", {}, warnings) : null,
    numbersGrid({ results, one, rows, names, shown, stable, millimetre }),
  ];
}

function numbersGrid({ results, one, rows, names, shown, stable, millimetre }) {
  return el(
    "div.scroll", { tabindex: 0 },
    el(
      "table.plain.numbers",
      {},
      tableHead(
        "run",
        "verdict",
        el("th", { scope: "col", title: stepForTitle }, `dt for 1 m${results.units[one.main] ?? "m"}`),
        "largest stable dt",
        "CPU a step",
        names.map((name) => el("th", { scope: "col", title: results.summaries[name] }, words(name))),
      ),
      el(
        "tbody",
        {},
        rows.map(([engine, cell]) => {
          const verdict = judgement(cell);
          const numbers = hasNumbers(cell)
            ? names.map((name) => shown(cell, name))
            : [el("td.text", { colspan: names.length }, cell.reason || verdict.word)];
          return el(
            "tr",
            {},
            el(
              "th",
              { scope: "row" },
              el("span.swatch", {
                class: engine.stock ? "swatch is-stock" : "swatch",
                style: { "--engine": `var(--e${engine.index})` },
              }),
              engine.name,
              engine.isSingle ? el("span.precision", { title: singleTitle }, " single") : null,
            ),
            el(`td.text.is-${verdict.kind}`, {}, el("span.word", {}, `${verdict.sign} ${verdict.word}`)),
            el("td", {}, millimetre(engine)),
            el("td", {}, stable(engine)),
            el(
              "td",
              {},
              isNumber(cell.cpu_seconds) && cell.cpu_seconds > 0
                ? quantity((cell.cpu_seconds * cell.dt_seconds) / one.duration, "s")
                : "–",
            ),
            numbers,
          );
        }),
      ),
    ),
  );
}

export function limitText(gate, unit) {
  const value = (v) => (unit === "1" ? digits(v) : quantity(v, unit));
  const parts = [];
  if (isNumber(gate.min)) parts.push(`at least ${value(gate.min)}`);
  if (isNumber(gate.max)) parts.push(`at most ${value(gate.max)}`);
  if (isNumber(gate.equals)) parts.push(`equal to ${value(gate.equals)}`);
  if (isNumber(gate.at_least_order)) parts.push(`falls at least with order ${gate.at_least_order}`);
  if (gate.at_least_order === "declared") parts.push("falls with the order that its method declares");
  if (isNumber(gate.regression)) parts.push(`within ${gate.regression} times the recorded value`);
  const said = ["kind", "metric", "min", "max", "equals", "at_least_order", "regression", "because", "where", "answers"];
  for (const [key, v] of Object.entries(gate)) {
    if (!said.includes(key) && (isNumber(v) || (typeof v === "string" && v))) parts.push(`${words(key)} ${v}`);
  }
  return parts.join(", ");
}

// The command that says which known mistake a run's error looks like, for each run that a gate failed on.
function diagnosisLine(one, gates) {
  const failed = gates.flatMap((gate) => gate.answers.filter((a) => a.answer === "failed" && a.engine));
  const runs = [...new Set(failed.map((a) => a.engine))];
  if (!runs.length) return [];
  const commands = runs.map((run) => [el("code", {}, `rigor diagnose ${one.id} --engine '${run}'`), " "]);
  return [el("p.fine", {}, "Which known mistake the error looks like: ", commands.flat())];
}

const gateMarks = { held: ["good", "✓"], failed: ["bad", "✕"], "not checked": ["none", "–"] };

// How many answers of a gate are of each kind, and in words.
function gateCounts(gate) {
  const count = (answer) => gate.answers.filter((a) => a.answer === answer).length;
  const failed = count("failed"),
    unchecked = count("not checked"),
    unrecorded = count("not recorded"),
    qualified = gate.answers.filter((a) => a.caveat).length;
  const summary = [
    `${count("held")} held`,
    qualified ? `${qualified} of them by runs stepped in part by less than their method` : "",
    failed ? `${failed} failed` : "",
    unchecked ? `${unchecked} not checked` : "",
    unrecorded ? `${unrecorded} not recorded` : "",
  ];
  return { failed, unchecked, qualified, summary: summary.filter(Boolean).join(", ") };
}

function gateRow({ results, one }, gate, answer) {
  const [kind, sign] = gateMarks[answer.answer] ?? ["none", "?"],
    value = metricOf(cellOf(one, answer.engine, answer.dt), gate.metric);
  return el(
    "tr",
    {},
    el("th", { scope: "row" }, answer.engine || "–"),
    el("td", {}, answer.dt || "all"),
    el("td", {}, value === null ? "" : quantity(value, results.units[gate.metric])),
    el(`td.is-${kind}`, {}, el("span.word", {}, `${sign} ${answer.answer}`)),
    el("td.text", {}, [answer.text, answer.caveat && `but ${answer.caveat}`].filter(Boolean).join(", ")),
  );
}

function gateDetails(context, gate) {
  const { failed, unchecked, qualified, summary } = gateCounts(gate);
  const [kind, sign] = failed ? ["bad", "✕"] : unchecked ? ["none", "–"] : ["good", "✓"];
  return el(
    "details.gate",
    { open: failed + qualified > 0 },
    el(
      "summary",
      {},
      el(`span.badge.is-${kind}`, {}, sign),
      el("b", {}, words(gate.metric)),
      " ",
      limitText(gate, context.results.units[gate.metric] ?? ""),
      el("span.fine", {}, ` ${gate.kind}`),
      el("span.fine", {}, ` ${summary}`),
      el("span.because", {}, gate.because),
    ),
    el(
      "div.scroll",
      { tabindex: 0 },
      el(
        "table.plain",
        {},
        tableHead("run", "dt", "value", "", "in words"),
        el("tbody", {}, gate.answers.map((answer) => gateRow(context, gate, answer))),
      ),
    ),
    el("p.fine", {}, gate.where),
  );
}

export function gatesTable({ results, one }) {
  // One of the family's that met no cell of this case says nothing about it.
  const gates = one.gates.filter((gate) => gate.answers.length);
  if (!gates.length) return el("p.fine", {}, "This case has no gates.");
  return el("div.gates", {}, diagnosisLine(one, gates), gates.map((gate) => gateDetails({ results, one }, gate)));
}

export function settingsTable({ one, dt, results }) {
  const cells = results.engines
    .map((e) => cellOf(one, e.name, dt.text))
    .filter((cell) => cell && Object.keys(cell.settings ?? {}).length);
  if (!cells.length) return el("p.fine", {}, "None were read back.");
  return el(
    "div.settings",
    {},
    cells.map((cell) =>
      el(
        "details",
        {},
        el("summary", {}, cell.engine),
        el(
          "dl",
          {},
          Object.entries(cell.settings).map(([name, value]) => [el("dt", {}, name), el("dd", {}, value)]),
        ),
      ),
    ),
  );
}

// TOML, its comments, tables and keys set apart.
export function sceneFile(one) {
  const lines = (one.file ?? "").split("\n").map((line) => {
    const [, before, comment] = /^((?:[^"#]|"(?:[^"\\]|\\.)*")*)(#.*)?$/.exec(line) ?? [null, line, ""];
    const key = /^(\s*)([\w-]+)(\s*=)(.*)$/.exec(before);
    const content = /^\s*\[/.test(before)
      ? [el("span.table", {}, before)]
      : key
        ? [key[1], el("span.name", {}, key[2]), key[3], key[4]]
        : [before];
    return [content, comment ? el("span.comment", {}, comment) : null, "\n"];
  });
  const copy = el(
    "button.quiet",
    {
      type: "button",
      onclick: () => navigator.clipboard?.writeText(one.file).then(() => (copy.textContent = "copied")),
    },
    "copy",
  );
  return el("div.file", {}, copy, el("pre", { tabindex: 0 }, el("code", {}, lines)));
}
