// A card for each engine: the largest step within the tolerance and its cost, what it is good at, and what goes wrong.
// Each line leads to its evidence.
import { cellOf, dtOf, hasNumbers, judgement, median, witnessed } from "./data.js";
import { el, replace, svg } from "./dom.js";
import { digits, quantity } from "./format.js";
import { cheapest, curvesOf, isExternal, isTimed, largestStep, mainCurves, mayBeTaken } from "./frontier.js";
import { lengthOrAngle } from "./frontier_chart.js";
import { address, openCase } from "./state.js";

const muchWorse = 2; // times the median engine's error: less is no weakness worth a line

const inPlainWords = {
  "blown up": "blows up",
  collapsed: "collapses",
  gaining: "gains energy",
  overlapping: "bodies overlap",
  tunnelled: "passes through a body",
};

const shapes = {
  step: "M8 1.5a6.5 6.5 0 1 0 0 13a6.5 6.5 0 0 0 0-13M8 4.5V8l2.6 1.6",
  strength: "M2.5 8.5l3.5 3.5l7.5-8",
  none: "M3 8h10",
  problem: "M8 2L1.5 13.5h13zM8 6.5v3.2M8 11.4v.8",
};
const icon = (kind, label) =>
  svg(
    "svg",
    { viewBox: "0 0 16 16", class: `icon is-${kind}`, role: "img", "aria-label": label },
    svg("title", {}, label),
    svg("path", { d: shapes[kind] }),
  );

export class EngineCards {
  constructor(results, { focus }) {
    (this.results = results), (this.focus = focus);
    this.root = el("div.cards", { "aria-label": "Engines" });
  }

  draw({ family, dt, tolerance }) {
    Object.assign(this, { family, dt, tolerance });
    this.cases = this.results.cases.filter((c) => !family || c.family === family);
    const curves = mainCurves(curvesOf(this.results, family), tolerance).filter((c) => !c.reference);
    this.typical = this.typicalErrors(curves);
    const best = cheapest(curves, tolerance, isExternal)?.curve; // as the headline says
    replace(
      this.root,
      curves.map((curve) => this.card(curve, curve === best)),
    );
  }

  // Of each case the median error of the engines at this step; of two in the middle the worse.
  typicalErrors(curves) {
    return new Map(
      this.cases.map((one) => [
        one,
        median(curves.map((c) => this.errorOf(one, c.engine)).filter((v) => v !== null)),
      ]),
    );
  }

  cellAt = (one, engine) => cellOf(one, engine, dtOf(one, this.dt.text).text);

  errorOf(one, engine) {
    const cell = this.cellAt(one, engine);
    const value = hasNumbers(cell) ? witnessed(cell, one.main) : null;
    return value > 0 ? value : null;
  }

  card(curve, isBest) {
    const { engine } = curve;
    return el(
      `article.card${isBest ? ".is-best" : ""}`,
      {
        style: { "--engine": `var(--e${curve.run.index})` },
        onmouseenter: () => this.focus(engine),
        onmouseleave: () => this.focus(null),
      },
      el("h2", {}, engine, isBest ? el("span.best", {}, "recommended") : null),
      this.stepLine(curve),
      this.strengthLine(curve),
      this.problemLine(curve),
    );
  }

  line = (kind, label, ...text) =>
    el("p", {}, icon(kind, label), el("span", {}, text));

  stepLine(curve) {
    const point = largestStep(curve, this.tolerance);
    const within = lengthOrAngle(this.tolerance);
    if (point)
      return this.line("step", "largest usable step", `${within} up to `, el("b", {}, `${point.dt} s`), isTimed(this.results) ? `, CPU ${quantity(point.cost, "s")} per s` : "");
    const finest = curve.points.at(-1);
    const isHidden = finest.mean <= this.tolerance && mayBeTaken(finest); // most cases are beyond it
    const why = isHidden ? ", half of the cases above it" : finest.failed ? `, ${finest.failed} of ${finest.cases} failed` : "";
    return this.line("step", "largest usable step", el("b.lacks", {}, `no step within ${within}`), `: ${lengthOrAngle(finest.mean)} at ${finest.dt} s${why}`);
  }

  // Families of cases by the engine's error over the median engine's, the best first.
  byFamily(engine) {
    const logs = new Map();
    for (const one of this.cases) {
      const error = this.errorOf(one, engine),
        typical = this.typical.get(one);
      if (error === null || !(typical > 0)) continue;
      const name = this.family ? one.id.slice(one.family.length + 1) : one.family || one.id;
      logs.set(name, [...(logs.get(name) ?? []), Math.log(Math.max(error, 1e-12) / Math.max(typical, 1e-12))]);
    }
    return [...logs]
      .map(([name, values]) => ({ name, ratio: Math.exp(values.reduce((a, b) => a + b) / values.length) }))
      .sort((a, b) => a.ratio - b.ratio);
  }

  strengthLine(curve) {
    const best = this.byFamily(curve.engine)[0];
    if (!best || !(best.ratio < 0.9)) return this.line("none", "good at", "no family with less error than the median engine");
    const times = 1 / best.ratio;
    return this.line("strength", "good at", el("b", {}, best.name), `: ${times >= 1000 ? "over 1000" : digits(times, 2)} × less error than the median`);
  }

  // At the largest usable step; where there is none, at the step of the matrix.
  problemLine(curve) {
    const step = largestStep(curve, this.tolerance)?.dt ?? this.dt.text;
    const judged = this.cases
      .map((one) => ({ one, verdict: judgement(cellOf(one, curve.engine, dtOf(one, step).text)) }))
      .filter(({ verdict }) => verdict.kind !== "none");
    const stable = judged.filter(({ verdict }) => verdict.kind === "good").length;
    const count = `stable in ${stable} of the ${judged.length} ${judged.length === 1 ? "case" : "cases"} that it runs at ${step} s`;
    const bad = judged.filter(({ verdict }) => verdict.kind === "bad");
    if (bad.length) return this.line("problem", "what goes wrong", ...this.worstKind(bad, curve.engine, step), `; ${count}`);
    const worst = this.byFamily(curve.engine).at(-1);
    if (worst?.ratio > muchWorse)
      return this.line("problem", "what goes wrong", el("b", {}, worst.name), `: ${digits(worst.ratio, 2)} × the median engine's error; ${count}`);
    return this.line("strength", "what goes wrong", `nothing fails; ${count}`);
  }

  // The most frequent kind of failure, and its first case.
  worstKind(bad, engine, step) {
    const kinds = new Map();
    for (const { one, verdict } of bad) {
      const kind = verdict.word.replace(/ (at |from |after )?[0-9].*$/, "");
      kinds.set(kind, [...(kinds.get(kind) ?? []), one]);
    }
    const [kind, cases] = [...kinds].sort((a, b) => b[1].length - a[1].length)[0];
    const others = bad.length - cases.length;
    const changes = { dt: dtOf(cases[0], step).text, engines: new Set([engine]) };
    const link = el(
      "a",
      {
        href: address({ case: cases[0].id, ...changes }),
        onclick: (event) => (event.preventDefault(), openCase(cases[0].id, changes)),
      },
      cases[0].id,
    );
    const count = cases.length > 1 ? ` in ${cases.length} cases, as ` : " in ";
    return [el("b", {}, inPlainWords[kind] ?? kind), count, link, others ? `; ${others} ${others === 1 ? "fails" : "fail"} otherwise` : ""];
  }
}
