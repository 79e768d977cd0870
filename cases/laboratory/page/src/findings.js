// Tells what happens and why, by a row of figures for each run and the sentences of the report on them.
import { el, replace } from "../../../report/html/page/src/dom.js";
import { digits, isNumber, percent, quantity } from "../../../report/html/page/src/format.js";
import { shortName } from "./run_names.js";

export class Findings {
  constructor(app) {
    this.app = app;
    this.sentence = el("p.sentence", { id: "sentence", "aria-live": "polite" });
    this.more = el("div.more-sentences");
    this.table = el("tbody");
    this.truthNote = el("p.fine", { id: "truth-note" });
    this.root = el(
      "section.findings-now",
      { "aria-label": "What happens, and why" },
      this.sentence,
      el(
        "div.scroll",
        {},
        el(
          "table.plain.now",
          {},
          el(
            "thead",
            {},
            el(
              "tr",
              {},
              ["method", "energy, of what is in play", "largest error", "turned wrong", "verdict"].map((text) =>
                el("th", { scope: "col" }, text),
              ),
            ),
          ),
          this.table,
        ),
      ),
      this.truthNote,
      this.more,
    );
  }

  // The sentences, once they are there.
  draw() {
    const { words } = this.app.bench,
      texts = sentencesOf(words);
    const first = texts[0] ?? this.plain();
    if (this.sentence.textContent !== first) this.sentence.textContent = first;
    replace(
      this.more,
      texts.slice(1, 5).map((text) => el("p.fine", {}, text)),
    );
    this.tick();
  }

  // Without a reason to give, the figures in words: distances, or angles where nothing moves away.
  plain() {
    const { bench } = this.app;
    if (bench.done === 0) return "Press play, or take one step.";
    const rows = bench.runs.map((run) => [run, bench.reading(run)]).filter(([, now]) => now && isNumber(now.position));
    if (rows.length === 0) return this.energies();
    const isTurning = rows.every(([, now]) => now.position < 1e-12),
      size = (now) => (isTurning ? now.orientation : now.position);
    const say = ([run, now]) =>
      `${shortName(run.name)} is ${quantity(size(now), isTurning ? "rad" : "m")} from the truth${lost(now)}`;
    rows.sort((a, b) => size(a[1]) - size(b[1]));
    return `After ${bench.time.toFixed(2)} s ${rows.map(say).join("; ")}.`;
  }

  // Of scenes without a truth.
  energies() {
    const { bench } = this.app,
      shares = bench.runs.map((run) => [shortName(run.name), energyShare(bench, run)]).filter(([, share]) => share);
    const say = ([name, share]) => `${share} by ${name}`;
    return shares.length > 0
      ? `After ${bench.time.toFixed(2)} s the energy has changed, of the energy in play: ${shares.map(say).join("; ")}.`
      : "";
  }

  tick() {
    const { bench } = this.app;
    replace(
      this.table,
      bench.runs.map((run, k) => this.row(run, k)),
    );
    this.truthNote.textContent = truthWords(bench.truth);
  }

  row(run, k) {
    const { bench } = this.app,
      now = bench.reading(run),
      verdict = run.cell?.verdict;
    const cells = [
      energyShare(bench, run),
      now && quantity(now.position, "m"),
      now && quantity(now.orientation, "rad"),
    ];
    const isBad = verdict?.word === "blown up" || run.ended;
    return el(
      "tr",
      { "data-run": run.name },
      el("th", { scope: "row" }, el(`span.line.run-${k}`, { "aria-hidden": "true" }), shortName(run.name)),
      cells.map((text) => el("td", {}, text ?? "–")),
      el(
        "td",
        {},
        el(`span.word${isBad ? ".is-bad" : ""}`, {}, isBad ? `✕ ${verdict?.word ?? "ended"}` : (verdict?.word ?? "")),
      ),
    );
  }
}

const lost = ({ orthonormality }) =>
  orthonormality > 1e-3 ? `, and its matrix is no rotation any more (|RᵀR − I| = ${digits(orthonormality)})` : "";

// First why something failed, as the report says it; then what the step does to the stiffest spring.
function sentencesOf(words) {
  if (!words?.ok) return [];
  const told = words.sentences.map((one) => one.text);
  const why = told.filter((text) => text.startsWith("Why:")),
    others = told.filter((text) => !text.startsWith("Why:"));
  return [...why, ...(words.mode && why.length === 0 ? [words.mode.text] : []), ...others];
}

// Of the energy in play, as the truth knows it.
function energyShare(bench, run) {
  const first = bench.reading(run, 0),
    now = bench.reading(run),
    inPlay = bench.truth?.kinetic;
  if (!first || !now || !(inPlay > 0)) return null;
  const share = (now.energy - first.energy) / inPlay;
  return `${share > 0 ? "+" : ""}${percent(share)}`;
}

function truthWords(truth) {
  if (!truth) return "The truth is being solved …";
  if (!truth.table) return `There is no truth to compare with: ${truth.whyNone ?? "none is known"}.`;
  if (truth.provisional) {
    const why = truth.whyNone ? ` (no truth: ${truth.whyNone})` : " until the truth is solved, which may take a minute";
    return `Compared with the core's dormand-prince at a tolerance of 1e-12${why}.`;
  }
  const { table, columns } = truth,
    rows = table.length / columns;
  let sure = 0;
  while (sure < rows && !(table[(sure + 1) * columns - 1] > 1e-6)) ++sure;
  if (sure < rows)
    return `Truth: ${truth.kind}, certain to 1 µm until ${(Math.max(0, sure - 1) * truth.dt).toFixed(2)} s.`;
  return `Truth: ${truth.kind}; its own error stays below ${digits(Math.max(table[table.length - 1], 1e-16))} m.`;
}
