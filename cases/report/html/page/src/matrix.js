// The matrix: cases by engines at one step. A cell's colour is its error in decades of the tolerance; its icon is the
// verdict on the motion as a whole. The two never stand for each other.
import {
  asideOf,
  cellOf,
  dtOf,
  hasNumbers,
  isHeldToItself,
  judgement,
  median,
  metricOf,
  levelOf,
  signedMetric,
  stableText,
  stepFor,
  tabulated,
} from "./data.js";
import { el, replace, tableHead } from "./dom.js";
import { digits, engineParts, isNumber, percent, quantity, singleTitle, words } from "./format.js";
import { curvesOf, largestStep } from "./frontier.js";
import { address, openCase, state } from "./state.js";

// Shown beside the metrics.
export const shownAside = {
  main: "the error that matters",
  stable: "largest stable dt",
  step: "dt needed for a tolerance",
  cost: "CPU time",
};

export const sortings = { name: "by family and name", error: "largest error first", cost: "most expensive first" };

// Up to so many columns can be read at once. With more, each engine shows its first run until it is opened.
const readableColumns = 7;
const readableRows = 55; // of one printed page; more are printed in two columns
const engineOf = (run) => run.name.split(/[:@,]/)[0];

export class Matrix {
  constructor(results) {
    (this.results = results), (this.root = el("div.matrix-scroll", { tabindex: -1 }));
    this.opened = new Set();
  }

  // Runs by engine, in the order in which engines first come.
  groups(runs) {
    const groups = new Map();
    for (const run of runs) groups.set(engineOf(run), [...(groups.get(engineOf(run)) ?? []), run]);
    return [...groups].map(([name, members]) => {
      const isOpen = runs.length <= readableColumns || this.opened.has(name);
      return { name, members, isOpen, shown: isOpen ? members : members.slice(0, 1) };
    });
  }

  toggle(name) {
    if (!this.opened.delete(name)) this.opened.add(name);
    this.draw(this.dt);
    [...this.root.querySelectorAll("button.open-engine")].find((button) => button.dataset.engine === name)?.focus();
  }

  // Words of the filter that name an engine choose columns; the others choose cases.
  draw(dt) {
    this.dt = dt;
    const ran = this.results.engines.filter((e) => this.results.cells.some((c) => c.engine === e.name));
    const words = state.filter.split(/\s+/).filter(Boolean);
    const isOfEngine = (word) => ran.some((e) => e.name.toLowerCase().startsWith(word));
    const engineWords = words.filter(isOfEngine),
      caseWords = words.filter((word) => !isOfEngine(word));
    const runs = engineWords.length
      ? ran.filter((e) => engineWords.some((word) => e.name.toLowerCase().startsWith(word)))
      : ran;
    const cases = this.results.cases.filter(
      (one) =>
        (!state.family || one.family === state.family) &&
        caseWords.every((word) => `${one.id} ${one.title}`.toLowerCase().includes(word)) &&
        this.hasVerdict(one, runs),
    );
    const groups = this.groups(runs),
      engines = groups.flatMap((group) => group.shown);
    const rare = engines.filter((e) => e.isRare).length;
    const families = new Map();
    for (const one of this.sorted(cases, runs)) {
      const key = state.sort === "name" ? one.family : sortings[state.sort];
      families.set(key, [...(families.get(key) ?? []), one]);
    }
    const table = el(
      "table.matrix",
      { "aria-label": `Cases by engines at dt = ${dt.text} s` },
      el("caption", {}, this.caption()),
      this.head(engines, runs.length > readableColumns ? groups : null),
      this.summary(cases, engines),
    );
    for (const [family, members] of families) {
      table.append(
        el(
          "tbody",
          {},
          el(
            "tr.family",
            {},
            el("th", { scope: "rowgroup", colspan: engines.length - rare + 1 }, el("span", {}, family || "cases")),
            rare ? el("td.is-rare", { colspan: rare }) : null,
          ),
          members.map((one) => this.row(one, engines)),
        ),
      );
    }
    this.root.classList.toggle("is-many", cases.length > readableRows);
    replace(this.root, cases.length ? table : el("p.nothing", {}, "No case matches these filters."));
  }

  cellAt = (one, engine) => cellOf(one, engine.name, dtOf(one, this.dt.text).text);

  hasVerdict(one, runs) {
    if (!state.verdict) return true;
    const kinds = runs.map((e) => judgement(this.cellAt(one, e)).kind).filter((kind) => kind !== "none");
    return state.verdict === "good" ? kinds.every((k) => k === "good") : kinds.includes(state.verdict);
  }

  sorted(cases, runs) {
    if (state.sort === "name") return [...cases].sort((a, b) => (a.id < b.id ? -1 : 1));
    const of = (one) => {
      const cells = runs.map((e) => this.cellAt(one, e)).filter(Boolean);
      const values = cells.map((c) => (state.sort === "cost" ? c.cpu_seconds / one.duration : metricOf(c, one.main)));
      return median(values.filter((v) => v !== null)) ?? -1;
    };
    return [...cases].sort((a, b) => of(b) - of(a));
  }

  caption() {
    const what = shownAside[state.show] ?? words(state.show);
    const tolerance =
      state.show === "step"
        ? ` of ${["m", "rad"].map((unit) => quantity(tabulated(this.results, state.tolerance), unit)).join(" or ")}`
        : "";
    const main =
      "position error; orientation error where nothing moves away; energy drift where there is no truth; (in brackets) the truth comes from the run's own code";
    return [
      el("b", {}, `dt = ${this.dt.text} s: ${what}${tolerance}`),
      " ",
      el("span.fine", {}, state.show === "main" ? main : (this.results.summaries[state.show] ?? "")),
      this.results.engines.some((e) => e.isRare)
        ? el("span.fine.only-print", {}, " – without the runs that only some cases ask for")
        : null,
    ];
  }

  // Over the columns, each engine's name, and how many more runs of it there are.
  engineHeads(groups) {
    const button = ({ name, members, isOpen }) =>
      el(
        "button.open-engine",
        {
          "aria-expanded": String(isOpen),
          "data-engine": name,
          title: isOpen ? `${name}: only its first run` : `${name}: all ${members.length} of its runs`,
          onclick: () => this.toggle(name),
        },
        isOpen ? `${name} −` : `${name} +${members.length - 1}`,
      );
    return el(
      "tr.engine-heads",
      {},
      el("td"),
      groups.map((group) =>
        el(
          "th",
          { scope: "colgroup", colspan: group.shown.length },
          group.members.length > 1 ? button(group) : group.name,
        ),
      ),
    );
  }

  head(engines, groups) {
    const head = tableHead(
      el("th.corner", { scope: "col" }, "case"),
      engines.map((engine) => {
        const [who, method] = engineParts(engine.name);
        return el(
          `th.engine${method.length > 24 ? ".is-long" : ""}${engine.isRare ? ".is-rare" : ""}`,
          { scope: "col", title: `${engine.name}: ${engine.engine ?? ""} ${engine.version ?? ""}` },
          el("span.stripe", { style: { "--engine": `var(--e${engine.index})` } }),
          el("span.who", {}, who.replace("@", " @\u200b")),
          method ? el("span.method", {}, method.replaceAll(/[-,=]/g, "$&\u200b")) : null,
          engine.isSingle ? el("span.method.precision", { title: singleTitle }, "single precision") : null,
        );
      }),
    );
    if (groups) head.prepend(this.engineHeads(groups));
    return head;
  }

  // The summary of an engine's column over all shown cases.
  summary(cases, engines) {
    const line = (label, title, of) =>
      el(
        "tr.summary",
        {},
        el("th", { scope: "row", title }, label),
        engines.map((engine) => el(engine.isRare ? "td.is-rare" : "td", {}, of(engine))),
      );
    const cells = (engine) =>
      cases
        .map((one) => cellOf(one, engine.name, dtOf(one, this.dt.text).text))
        .filter((c) => c && c.status !== "unsupported");
    // Computed over all cases, see results.json.
    const isAll = cases.length === this.results.cases.length;
    const ratio = (engine) => {
      const found = this.results.relative_errors?.find((r) => r.engine === engine.name && r.dt === this.dt.text);
      if (!isAll || !found) return "–";
      return isNumber(found.ratio) ? `× ${digits(found.ratio, 2)}` : "failed";
    };
    // By the rule of the headline and the cards.
    const curves = curvesOf(this.results, state.family);
    const usableStep = (engine) => {
      const curve = curves.find((c) => c.engine === engine.name);
      if (!curve || !(isAll || cases.every((one) => one.family === state.family))) return "–";
      const point = largestStep(curve, state.tolerance);
      return point ? `${point.dt} s` : "none";
    };
    const failures = (engine) => {
      const ran = cells(engine),
        bad = ran.filter((c) => judgement(c).kind === "bad").length;
      return ran.length ? el("span", { class: bad ? "some-bad" : "" }, `${bad} of ${ran.length}`) : "–";
    };
    return el(
      "tbody.summaries",
      {},
      line(
        "failed",
        "cells at this step that blew up, collapsed, gained energy, overlapped, crashed or failed a gate, of those that ran",
        failures,
      ),
      line(
        "error ÷ median engine",
        "median over all cases: the main error divided by the median engine's; below 1 is better than most. A failed cell counts as worse than any error",
        ratio,
      ),
      line(
        `step within ${quantity(state.tolerance, "m")}`,
        "the largest step whose typical error is within the tolerance. At most one case in twenty fails there. Typical: geometric mean and median",
        usableStep,
      ),
    );
  }

  row(one, engines) {
    const dt = dtOf(one, this.dt.text),
      isOther = dt.text !== this.dt.text;
    return el(
      "tr",
      {},
      el(
        "th.case",
        { scope: "row", title: one.title },
        el(
          "a",
          { href: address({ case: one.id, time: 0, zoom: null }), onclick: (event) => this.go(event, one, {}) },
          one.id.slice(one.family ? one.family.length + 1 : 0),
        ),
        el(
          "span.note",
          {},
          one.error
            ? "could not be judged"
            : [
                state.show === "main" ? words(one.main).replace(" synchronised", "") : one.title,
                isOther ? ` · dt ${dt.text}` : "",
              ],
        ),
      ),
      engines.map((engine) => this.cell(one, engine, dt)),
    );
  }

  cell(one, engine, dt) {
    const cell = cellOf(one, engine.name, dt.text),
      verdict = judgement(cell);
    const [value, note] = this.value(one, engine, cell, verdict);
    const shown = new Set([
      engine.name,
      ...one.cells
        .filter((c) => c.playback && c.dt === dt.text)
        .map((c) => c.engine)
        .filter((n) => !this.results.engines.find((e) => e.name === n)?.core)
        .slice(0, 3),
    ]);
    const changes = { case: one.id, dt: dt.text, engines: shown, time: 0, zoom: null };
    const rare = engine.isRare ? ".is-rare" : "";
    if (!cell) return el(`td.cell.is-absent${rare}`, {}, "");
    const title = `${one.id}, ${engine.name}, dt = ${dt.text} s: ${verdict.word}${asideOf(cell)}`;
    const level = levelOf(one, cell, state.tolerance);
    const isPlain = verdict.kind === "good" && !note;
    return el(
      `td.cell.is-${verdict.kind}${level === null ? "" : `.level-${level}`}${rare}`,
      {},
      el(
        "a",
        { href: address(changes), title, onclick: (event) => this.go(event, one, changes) },
        el("span.mark", { "aria-hidden": "true" }, verdict.sign),
        el("span.value", {}, value),
        el(`span.word${isPlain ? ".visually-hidden" : ""}`, {}, note ?? verdict.word),
      ),
    );
  }

  // The number of a cell, and a word that replaces the verdict where it says more.
  value(one, engine, cell, verdict) {
    if (state.show === "stable") {
      const stable = one.stable.get(engine.name);
      if (!stable || !isNumber(stable.dt))
        return ["–", stable && stable.status !== "unsupported" ? stable.status : undefined];
      return [stableText(stable)];
    }
    if (state.show === "step") {
      if (one.main === "energy_drift_synchronised") return ["–", "no truth"];
      return [stepFor(this.results, one, engine.name, state.tolerance) ?? "–"];
    }
    if (!hasNumbers(cell)) return [""];
    if (state.show === "cost")
      return [
        isNumber(cell.cpu_seconds) ? `${digits((1e6 * cell.cpu_seconds * cell.dt_seconds) / one.duration)} µs` : "–",
        "a step",
      ];
    const name = state.show === "main" ? one.main : state.show;
    const unit = this.results.units[name];
    if (unit === "1" && name.startsWith("energy")) {
      const signed = signedMetric(cell.metrics, name);
      return [signed === null ? "–" : (signed > 0 && Math.abs(signed) > 1e-11 ? "+" : "") + percent(signed)];
    }
    const value = metricOf(cell, name);
    if (value === null) return ["–", "not applicable"];
    return [isHeldToItself(cell, name) ? `(${quantity(value, unit)})` : quantity(value, unit)];
  }

  go(event, one, changes) {
    if (event.metaKey || event.ctrlKey || event.shiftKey) return;
    event.preventDefault();
    openCase(one.id, changes);
  }

  // Arrow keys go from cell to cell.
  key(event) {
    const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[event.key];
    const here = document.activeElement?.closest?.("td.cell, th.case");
    if (!step || !here || !this.root.contains(here)) return false;
    const rows = [...this.root.querySelectorAll("tbody tr")].filter((row) => row.querySelector("th.case"));
    const row = rows.indexOf(here.parentElement),
      column = [...here.parentElement.children].indexOf(here);
    const target = rows[row + step[0]]?.children[column + step[1]]?.querySelector("a");
    target?.focus();
    return Boolean(target);
  }
}
