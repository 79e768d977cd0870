// The first screen: the findings, and the matrix of cases by engines.
import { metricOf } from "./data.js";
import { el, replace, tableHead } from "./dom.js";
import { digits, quantity, words } from "./format.js";
import { Matrix, shownAside } from "./matrix.js";
import { address, onChange, openCase, set, state } from "./state.js";

export class Overview {
  constructor(results, root) {
    (this.results = results), (this.root = root), (this.filter = "");
    this.matrix = new Matrix(results);
    replace(root, this.intro(), this.controls(), this.matrix.root, this.legend(), this.details());
    this.draw();
    this.stop = onChange((changed) => {
      if (["dt", "show", "tolerance"].some((key) => changed.has(key))) this.draw();
    });
  }
  close() {
    this.stop();
  }

  get dt() {
    return (
      this.results.dts.find((dt) => dt.text === state.dt) ??
      this.results.dts.find((dt) => dt.text === this.results.headline_dt) ??
      this.results.dts[0]
    );
  }

  intro() {
    const { findings, cells } = this.results;
    const counts = new Map();
    for (const cell of cells) counts.set(cell.status, (counts.get(cell.status) ?? 0) + 1);
    const status = [...counts].map(([word, n]) => `${n} ${word}`).join(", ");
    return el(
      "section.intro",
      {},
      el("h1", {}, "How right each engine was"),
      findings.length ? this.findings(findings) : null,
      el("p.fine", {}, `${cells.length} cells: ${status}.`),
    );
  }

  // The findings: a card for each of the first topics, with details on a click; the others behind their names. The
  // names of cases are links.
  findings(findings) {
    const cards = 4;
    const link = (id) =>
      el("a", { href: address({ case: id }), onclick: (event) => (event.preventDefault(), openCase(id)) }, id);
    const linked = (text) =>
      text.split(/([\w.-]+(?:\/[\w.-]*\w)+)/).map((part) => (this.results.caseById.has(part) ? link(part) : part));
    const card = ({ topic, text, more }) =>
      el(
        "section.answer",
        {},
        el("h2", {}, topic),
        el("p.text", {}, linked(text)),
        more ? el("details", {}, el("summary", {}, "why, and who else"), el("p.more", {}, linked(more))) : null,
      );
    const folded = ({ topic, text, more }) =>
      el(
        "details.answer",
        {},
        el("summary", {}, el("h2", {}, topic)),
        el("p.text", {}, linked(text)),
        more ? el("p.more", {}, linked(more)) : null,
      );
    return [
      el("div.answers", {}, findings.slice(0, cards).map(card)),
      el("div.answers", {}, findings.slice(cards).map(folded)),
    ];
  }

  controls() {
    const select = (label, value, options, onchange) =>
      el(
        "label.control",
        {},
        el("span", {}, label),
        el(
          "select",
          { onchange: (event) => onchange(event.target.value) },
          options.map(([key, text]) => el("option", { value: key, selected: key === value }, text)),
        ),
      );
    const measured = this.results.metrics
      .map((m) => m.name)
      .filter((name) => this.results.cells.some((c) => metricOf(c, name) !== null));
    const tolerances = [1e-4, 1e-3, 1e-2, 1e-1];
    return el(
      "div.controls",
      {},
      select(
        "Step",
        this.dt.text,
        this.results.dts.map((dt) => [dt.text, `dt = ${dt.text} s`]),
        (dt) => set({ dt }),
      ),
      select(
        "Show",
        state.show,
        [...Object.entries(shownAside), ...measured.map((name) => [name, words(name)])],
        (show) => set({ show }),
      ),
      select(
        "Tolerance",
        String(state.tolerance),
        tolerances.map((t) => [String(t), `${quantity(t, "m")} or ${quantity(t, "rad")}`]),
        (t) => set({ tolerance: Number(t) }),
      ),
      el(
        "label.control",
        {},
        el("span", {}, "Cases"),
        el("input", {
          type: "search",
          placeholder: "filter by name",
          oninput: (event) => {
            this.filter = event.target.value.toLowerCase();
            this.draw();
          },
        }),
      ),
    );
  }

  legend() {
    const item = (kind, sign, text) => el("span.key", {}, el(`span.swatch.is-${kind}`, {}, sign), text);
    return el(
      "p.legend",
      {},
      item("good", "✓", "stable"),
      item("drift", "≈", "drifting: its mean energy moved by more than 1 %, or an unexpected pass"),
      item("bad", "∩", "two bodies overlap by a body's own size"),
      item("bad", "↑", "gaining energy that nothing gives it"),
      item("bad", "↓", "collapsed: it had to stand"),
      item("bad", "»", "tunnelled: bodies passed through each other"),
      item("bad", "✕", "blown up, crashed, or a gate failed"),
      item("known", "◆", "known deviation"),
      item("none", "–", "cannot be run on this engine"),
      el("span.key", {}, "A cell's colour: its position error beside the case's size, green at 1e-4 of it, red at all of it."),
    );
  }

  details() {
    const { machine, program, engines, wall_seconds: wall } = this.results;
    return el(
      "details.about",
      {},
      el("summary", {}, "Machine, versions and methods"),
      el(
        "p",
        {},
        `rigor ${program.version} on ${machine.cpu} (${machine.cores} cores), ${machine.compiler}, ${machine.build_type} build; ${digits(wall)} s.`,
      ),
      el(
        "div.scroll",
        {},
        el(
          "table.plain",
          {},
          tableHead("run", "engine", "version", "precision", "method", "order", "symplectic"),
          el(
            "tbody",
            {},
            engines.map((e) =>
              el(
                "tr",
                {},
                el("th", { scope: "row" }, e.name),
                el("td", {}, e.engine),
                el("td", {}, e.version),
                el("td", {}, e.precision),
                el("td", {}, e.method),
                el("td", {}, e.order),
                el("td", {}, e.symplectic ? "yes" : "no"),
              ),
            ),
          ),
        ),
      ),
      el(
        "p.fine",
        {},
        "The settings in force, as read back from each engine, stand in every case. The full precision of each run is in trajectories/*.csv, everything shown here in results.json.",
      ),
    );
  }

  draw() {
    this.matrix.draw(this.dt, this.filter);
  }

  key(event) {
    return this.matrix.key(event);
  }
}
