// Whose contact forces can be trusted: for each engine, over all cases with reported contact forces, in shares of the
// weight. First of all: do the forces explain the motion?
import { judgement, metricOf } from "./data.js";
import { el, tableHead } from "./dom.js";
import { percent } from "./format.js";
import { address, openCase } from "./state.js";

// N, of all that moves; null without gravity.
function weightOf({ scene }) {
  const mass = scene.bodies.reduce((sum, body) => sum + (body.fixed ? 0 : body.mass), 0),
    weight = mass * Math.hypot(...scene.gravity);
  return weight > 0 ? weight : null;
}

const worstOf = (list) => list.reduce((worst, one) => (worst && worst.value >= one.value ? worst : one), null);
const middleOf = (list) => [...list].sort((a, b) => a.value - b.value)[Math.floor((list.length - 1) / 2)] ?? null;

// A value for each cell of an engine that has it: forces in shares of the weight, and of a peak what is beyond 1.
function valuesOf(results, engine, metric) {
  const found = [];
  for (const one of results.cases) {
    const weight = weightOf(one);
    if (!weight) continue;
    for (const cell of one.cells.filter((c) => c.engine === engine.name)) {
      const value = metricOf(cell, metric);
      if (value !== null) found.push({ value: metric === "force_peak" ? Math.max(0, value - 1) : value / weight, cell, one });
    }
  }
  return found;
}

// Of each case, the values at the finest step that has one.
function atFinestStep(values) {
  const finest = new Map();
  for (const value of values) {
    const known = finest.get(value.one);
    if (!known || value.cell.dt_seconds < known.cell.dt_seconds) finest.set(value.one, value);
  }
  return [...finest.values()];
}

// The columns: what is read from the cells, and up to where it is good, and nearly so.
const columns = [
  { title: "unexplained by the forces, worst", of: (values) => worstOf(values), metric: "contact_balance", good: 1e-6, nearly: 1e-3 },
  { title: "wrong at the finest step, middle case", of: (values) => middleOf(atFinestStep(values)), metric: "contact_force_error", good: 1e-3, nearly: 0.1 },
  { title: "largest force at rest, beyond the weight", of: (values) => worstOf(values), metric: "force_peak", good: 0.01, nearly: 0.1 },
  { title: "beyond the friction cone, worst", of: (values) => worstOf(values), metric: "coulomb_residual", good: 1e-6, nearly: 1e-3 },
];

const kindOf = (found, { good, nearly }) => (!found ? "none" : found.value <= good ? "good" : found.value <= nearly ? "drift" : "bad");
const sign = { good: "✓", drift: "≈", bad: "✕", none: "" };

// Runs of Rigor's own engine stand together, with the worst of them.
function groupsOf(results) {
  const groups = results.engines.filter((engine) => !engine.core).map((engine) => ({ name: engine.name, engines: [engine] }));
  const own = results.engines.filter((engine) => engine.core);
  if (own.length) groups.push({ name: own.length > 1 ? `core, ${own.length} methods` : own[0].name, engines: own });
  return groups;
}

export function trustRows(results) {
  const rows = groupsOf(results).map(({ name, engines }) => ({
    name,
    engines,
    found: columns.map(({ of, metric }) => worstOf(engines.map((engine) => of(valuesOf(results, engine, metric))).filter(Boolean))),
  }));
  for (const row of rows) {
    const ran = results.cells.filter((cell) => cell.status !== "unsupported" && row.engines.some(({ name }) => name === cell.engine));
    row.ran = ran.length;
    row.failed = ran.filter((cell) => judgement(cell).kind === "bad").length;
    row.kinds = row.found.map((found, i) => kindOf(found, columns[i]));
  }
  return rows.filter(({ ran }) => ran > 0);
}

// Null unless at least half of the cases compare contact forces.
export function forceTrust(results) {
  const compared = results.cases.filter((one) => one.cells.some((cell) => metricOf(cell, "contact_balance") !== null));
  if (!compared.length || 2 * compared.length < results.cases.length) return null;
  const all = trustRows(results),
    rows = all.filter(({ found }) => found[0]),
    silent = all.filter(({ found, failed, ran }) => !found[0] && failed < ran);
  const isRight = ({ kinds, failed }) => failed === 0 && kinds.every((kind) => kind === "good"),
    isRed = ({ kinds }) => kinds.includes("bad"),
    explains = rows.filter((row) => row.kinds[0] === "good" && !isRight(row)),
    named = (list) => el("b", {}, list.map(({ name }) => name).join(", ")),
    sentence = (words, list) => (list.length ? [`${words}: `, named(list), ". "] : []);
  return el(
    "section.part.trust",
    { id: "trust" },
    el("h2", {}, "Whose contact forces can be trusted"),
    el(
      "p",
      {},
      sentence("Right in every column", rows.filter(isRight)),
      sentence("They explain the motion, but look at the red cells", explains.filter(isRed)),
      sentence("They explain the motion, as far as they were compared", explains.filter((row) => !isRed(row))),
      sentence("They do not explain the motion", rows.filter((row) => row.kinds[0] !== "good")),
      sentence("No contact forces are reported", silent),
    ),
    el(
      "div.scroll",
      { tabindex: 0, role: "region", "aria-label": "Trust in contact forces" },
      el(
        "table.plain",
        {},
        tableHead("engine", ...columns.map(({ title }) => title), "runs that failed"),
        el(
          "tbody",
          {},
          rows.map(({ name, found, kinds, failed, ran }) =>
            el(
              "tr",
              { "data-engine": name },
              el("th", { scope: "row" }, name),
              found.map((one, i) => cellOf(one, kinds[i])),
              el("td", {}, `${failed} of ${ran}`),
            ),
          ),
        ),
      ),
    ),
    el(
      "p.fine",
      {},
      "Shares of the weight of all that moves. Unexplained: the change of momentum less the reported forces. Wrong: against the true force between each pair. A click leads to the case.",
    ),
  );
}

function cellOf(found, kind) {
  if (!found) return el("td.none", {}, "–");
  const { one, cell, value } = found;
  return el(
    `td.is-${kind}`,
    { title: `${one.id}, ${cell.engine} at ${cell.dt} s` },
    el(
      "a",
      { href: address({ case: one.id }), onclick: (event) => (event.preventDefault(), openCase(one.id)) },
      `${sign[kind]} ${percent(value)}`,
    ),
  );
}
