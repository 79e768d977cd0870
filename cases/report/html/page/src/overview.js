// The first screen: which engine and step to take, the picture that says why, the problems found, and the matrix.
import { judgement, metricOf, nothingMoves } from "./data.js";
import { afterFirstPaint, el, replace, tableHead } from "./dom.js";
import { EngineCards } from "./engine_cards.js";
import { forceTrust } from "./force_trust.js";
import { digits, quantity, words } from "./format.js";
import { cheapest, curvesOf, engineOf, families, isCoreMethod, isExternal, isReference, isTimed } from "./frontier.js";
import { FrontierChart, lengthOrAngle } from "./frontier_chart.js";
import { Matrix, shownAside, sortings } from "./matrix.js";
import { problems } from "./problems.js";
import { onChange, set, state } from "./state.js";

const verdictFilters = [
  ["", "any"],
  ["bad", "something fails"],
  ["drift", "something drifts"],
  ["good", "all stable"],
];

const isRun = (cell) => cell.status !== "unsupported";

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

const nameFilter = () =>
  el(
    "label.control",
    {},
    el("span", {}, "Cases and engines"),
    el("input", {
      type: "search",
      placeholder: "filter by name",
      value: state.filter,
      oninput: (event) => set({ filter: event.target.value.toLowerCase() }),
    }),
  );

export class Overview {
  constructor(results, root) {
    (this.results = results), (this.root = root);
    this.matrix = new Matrix(results);
    this.chart = new FrontierChart({
      timed: isTimed(results),
      pickTolerance: (tolerance) => set({ tolerance }),
      pickRun: (run) => ((this.focused = this.focused === run ? null : run), this.drawFirst()),
    });
    this.cards = new EngineCards(results, {
      focus: (run) => ((this.focused = run), this.drawChart()),
    });
    this.answer = el("div.answer-first", {});
    replace(
      root,
      (results.not_the_same_robot ?? []).map((text) => el("p.other-robot", {}, text)),
      this.answer,
      forceTrust(results),
      this.hasCurves ? el("div.first", {}, this.chart.root, this.cards.root) : null,
      this.meanings(),
      problems(results),
      el("section.part", { id: "matrix" }, el("h2", {}, "Every case"), this.controls(), this.matrix.root, this.legend()),
      this.details(),
    );
    this.drawFirst();
    // A long matrix takes as long as all that is above it.
    this.whole = afterFirstPaint().then(() => this.isClosed || this.drawMatrix());
    this.stop = onChange((changed) => {
      if (["tolerance", "family", "dt"].some((key) => changed.has(key))) this.drawFirst();
      if (["dt", "show", "tolerance", "family", "sort", "filter", "verdict"].some((key) => changed.has(key))) this.drawMatrix();
    });
  }
  close() {
    this.isClosed = true;
    this.stop();
  }

  get hasCurves() {
    return curvesOf(this.results, "").length > 0 && !this.isStill;
  }
  get isStill() {
    const { cases } = this.results;
    return cases.length > 0 && cases.every(({ truth }) => truth.still);
  }
  get family() {
    return families(this.results).includes(state.family) ? state.family : "";
  }
  get dt() {
    return (
      this.results.dts.find((dt) => dt.text === state.dt) ??
      this.results.dts.find((dt) => dt.text === this.results.headline_dt) ??
      this.results.dts[0]
    );
  }

  drawMatrix() {
    this.matrix.draw(this.dt);
  }

  drawFirst() {
    this.curves = this.hasCurves ? curvesOf(this.results, this.family) : [];
    replace(this.answer, this.sentence());
    if (!this.hasCurves) return;
    this.drawChart();
    this.cards.draw({ family: this.family, dt: this.dt, tolerance: state.tolerance });
  }

  drawChart() {
    const { tolerance } = state;
    const chosen = cheapest(this.curves, tolerance, isExternal) ?? cheapest(this.curves, tolerance, isCoreMethod);
    this.chart.draw({ curves: this.curves, tolerance, chosen, focus: this.focused });
  }

  // One sentence: the engine and step to take; then who else is within the tolerance, and what the core does.
  sentence() {
    const { cases } = this.results,
      { tolerance } = state;
    const counted = this.family ? cases.filter((c) => c.family === this.family).length : cases.length;
    const of = (choice) => `${choice.curve.engine} at ${choice.point.dt} s`;
    const best = cheapest(this.curves, tolerance, isExternal);
    const recorded = this.results.findings.find((found) => found.topic === "recorded");
    const title = !this.hasCurves
      ? this.isStill
        ? nothingMoves(cases.length)
        : (recorded?.text ?? this.withoutErrors())
      : best
        ? ["For ", el("b", {}, lengthOrAngle(tolerance)), " take ", el("b", {}, best.curve.engine), " at ", el("b", {}, `${best.point.dt} s`)]
        : `No engine stays within ${lengthOrAngle(tolerance)} at the steps tried`;
    const beside = this.isStill ? [this.failures()] : this.hasCurves || !recorded ? [] : [recorded.more, this.failures()];
    if (best) {
      const { cases: compared, failed } = best.point,
        { unsupported } = best.curve;
      const outcome = failed ? `${failed} failed` : "none failed";
      const lacks = unsupported ? ` It cannot run ${unsupported}.` : "";
      beside.push(
        counted === 1
          ? `It is the cheapest external engine within ${lengthOrAngle(tolerance)} in this case.`
          : `It is the cheapest external engine with a typical error within ${lengthOrAngle(tolerance)}. ${compared} of ${counted} cases were compared with their true motion; ${outcome}.${lacks}`,
      );
    }
    const others = this.othersWithin(best, tolerance);
    if (others.length) beside.push(`Also within: ${others.slice(0, 3).map(of).join(", ")}.`);
    const own = cheapest(this.curves, tolerance, isCoreMethod),
      reference = cheapest(this.curves, tolerance, isReference);
    if (own) beside.push(`Rigor's own core stands apart: ${of(own)}.`);
    if (reference) beside.push(`Reference: ${of(reference)}.`);
    return [
      el("h1", {}, title),
      el(
        "p.beside",
        {},
        beside.join(" "),
        this.family ? el("button.quiet", { type: "button", onclick: () => set({ family: "" }) }, "all families") : null,
      ),
    ];
  }

  withoutErrors() {
    return this.results.cells.some(isRun) ? `No error can be compared here; ${this.failures()}` : "Nothing ran here";
  }

  // "4 of 18 runs failed."
  failures() {
    const ran = this.results.cells.filter(isRun),
      failed = ran.filter((cell) => judgement(cell).kind === "bad").length;
    return `${failed} of ${ran.length} runs failed.`;
  }

  // The cheapest step within the tolerance of each other engine, cheapest first.
  othersWithin(best, tolerance) {
    const names = new Set(this.curves.filter(isExternal).map(engineOf));
    if (best) names.delete(engineOf(best.curve));
    return [...names]
      .map((name) => cheapest(this.curves, tolerance, (c) => isExternal(c) && engineOf(c) === name))
      .filter(Boolean)
      .sort((a, b) => a.point.cost - b.point.cost);
  }

  meanings() {
    return el(
      "p.meanings",
      {},
      el("b", {}, "Error"),
      ": the distance from the true motion. ",
      el("b", {}, "Stable"),
      ": the motion does not blow up, fall apart or drift in energy. A stable run can still be far from the truth.",
      this.results.engines.some((e) => e.name.endsWith("@stock")) ? [el("b", {}, " @stock"), ": with the settings that the engine ships."] : null,
    );
  }

  controls() {
    const measured = this.results.metrics
      .map((m) => m.name)
      .filter((name) => this.results.cells.some((c) => metricOf(c, name) !== null));
    const tolerances = [...new Set([1e-4, 1e-3, 1e-2, 1e-1, state.tolerance])].sort((a, b) => a - b);
    const dts = this.results.dts.map((dt) => [dt.text, `dt = ${dt.text} s`]);
    const shows = [...Object.entries(shownAside), ...measured.map((name) => [name, words(name)])];
    const bounds = tolerances.map((t) => [String(t), `${quantity(t, "m")} or ${quantity(t, "rad")}`]);
    const familyNames = families(this.results).map((f) => [f, f]);
    return el(
      "div.controls",
      {},
      select("Step", this.dt.text, dts, (dt) => set({ dt })),
      select("Show", state.show, shows, (show) => set({ show })),
      select("Tolerance", String(state.tolerance), bounds, (t) => set({ tolerance: Number(t) })),
      familyNames.length > 1
        ? select("Family", this.family, [["", "all families"], ...familyNames], (family) => set({ family }))
        : null,
      select("Sort", state.sort, Object.entries(sortings), (sort) => set({ sort })),
      select("Verdict", state.verdict, verdictFilters, (verdict) => set({ verdict })),
      nameFilter(),
    );
  }

  legend() {
    const item = (kind, sign, text) => el("span.key", {}, el(`span.swatch.is-${kind}`, {}, sign), text);
    const shade = (level) => el(`span.swatch.level-${level}`, {}, " ");
    return el(
      "p.legend",
      {},
      el("span.key", {}, "error: ", [0, 1, 2, 3, 4, 5].map(shade), " within a hundredth of the tolerance … 1000 × beyond it"),
      item("good", "✓", "stable"),
      item("drift", "≈", "drifts in energy"),
      item("bad", "✕", "failed: blown up, collapsed ↓, gains energy ↑, overlaps ∩, crashed !"),
      item("known", "◆", "known deviation"),
      item("none", "–", "unsupported"),
    );
  }

  details() {
    const { machine, program, engines, wall_seconds: wall, cells } = this.results;
    const counts = new Map();
    for (const cell of cells) counts.set(cell.status, (counts.get(cell.status) ?? 0) + 1);
    const status = [...counts].map(([word, n]) => `${n} ${word}`).join(", ");
    return el(
      "details.about",
      {},
      el("summary", {}, "Machine, versions and methods"),
      el(
        "p",
        {},
        `rigor ${program.version} on ${machine.cpu} (${machine.cores} cores), ${machine.compiler}, ${machine.build_type} build; ${digits(wall)} s. ${cells.length} cells: ${status}.`,
      ),
      el(
        "div.scroll",
        { tabindex: 0, role: "region", "aria-label": "Versions and methods" },
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
        "Each case shows the settings in force, as read back from the engine. The folder trajectories/ holds each run in full precision; results.json holds everything shown here.",
      ),
    );
  }

  key(event) {
    return this.matrix.key(event);
  }
}
