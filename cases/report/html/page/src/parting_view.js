// Shows where the two runs of `rigor diverge` part: the answer, the plot, the causes, and the settings tried.
import { el, tableHead } from "./dom.js";
import { digits, percent } from "./format.js";
import { PartingChart } from "./parting_chart.js";
import { answerLines, falls, injectionLines, isNamed, reason, settingLine, stepsNote, swapText, title } from "./parting_words.js";
import { copied } from "./repair.js";

// Of a report that `rigor diverge` wrote; null in any other.
export const divergence = JSON.parse(document.getElementById("rigor-divergence")?.textContent ?? "null");

// The page opens at the instant of the parting, with the first run's step.
export const firstView = () => ({ case: divergence.case, dt: divergence.a.dt, time: divergence.parting?.time ?? 0 });

export const partingAnswer = (found) => [el("h1", {}, title(found)), answerLines(found).map((line) => el("p.beside", {}, line))];

const textHead = (label) => el("th.text", { scope: "col" }, label);

function causes(found) {
  if (!found.causes?.length) return null;
  const row = (cause) =>
    el(
      "tr",
      {},
      el("th", { scope: "row" }, `${digits(cause.time, 5)} s`),
      el("td.text", {}, cause.body),
      el("td", {}, digits(cause.share)),
      el("td.text", {}, reason(cause)),
      el("td", {}, isNamed(cause) ? percent(cause.explains, 3) : "–"),
      el("td.text", {}, isNamed(cause) || !cause.part ? falls(cause) : "–"),
    );
  return [
    el("h3", {}, "Why"),
    el("p.fine", {}, "The largest one-step differences. “Adds” counts in bounds, after free motion until the runs part. The difference vanishes without the named part of the scene."),
    el(
      "div.scroll",
      { tabindex: 0 },
      el("table.plain.causes", {}, tableHead("from", textHead("body"), "adds", textHead("part of the scene"), "explains", textHead("falls with dt?")), el("tbody", {}, found.causes.map(row))),
    ),
  ];
}

function settings(found) {
  const isBest = (swap) => found.setting && JSON.stringify(swap.swaps) === JSON.stringify(found.setting.swaps);
  const row = (swap) =>
    el(
      isBest(swap) ? "tr.is-best" : "tr",
      {},
      el("th", { scope: "row" }, swapText(found, swap), isBest(swap) ? el("span.best", {}, "closes the gap") : null),
      el("td", {}, percent(swap.closes, 3)),
      el("td", {}, swap.closes_at_half_step === null ? "–" : percent(swap.closes_at_half_step, 3)),
    );
  const tried = [...(found.swaps ?? [])].sort((x, y) => y.closes - x.closes);
  const table = (rows) => el("table.plain.swaps", {}, tableHead("a setting of one run is changed", "closes of the gap", "at half the step"), el("tbody", {}, rows.map(row)));
  const scroll = (rows) => el("div.scroll", { tabindex: 0 }, table(rows));
  const few = tried.length > 15 ? 12 : 15;
  return [
    el("h3", {}, "Settings tried"),
    el("p", {}, settingLine(found)),
    tried.length ? el("p.fine", {}, "Negative: the gap widens. Only the best ones are run again at half the step.") : null,
    tried.length ? scroll(tried.slice(0, few)) : null,
    tried.length > few ? el("details", {}, el("summary", {}, `${tried.length - few} more`), scroll(tried.slice(few))) : null,
    calls(found),
  ];
}

function calls(found) {
  if (!found.command && !found.calls?.length) return null;
  const text = (found.calls ?? []).join("\n");
  return [
    found.command ? el("p", {}, "Run the changed setting: ", el("code", {}, found.command), copied(found.command)) : null,
    text ? [el("p.fine", {}, "The engine's own calls for it:"), el("pre", { tabindex: 0 }, el("code", {}, text)), copied(text)] : null,
  ];
}

export class PartingView {
  constructor(found, player) {
    const hasPlot = PartingChart.isWorthwhile(found);
    this.chart = hasPlot ? new PartingChart(found, player) : null;
    this.root = el(
      "section.part",
      { id: "divergence" },
      el("h2", {}, "Where they part"),
      el("p.fine", {}, `${found.a.run} at ${found.a.dt} s against ${found.b.run} at ${found.b.dt} s. A share of 1 is the bound.`),
      stepsNote(found) ? el("p", {}, stepsNote(found)) : null,
      this.chart?.root ?? el("p", {}, "There is nothing to plot: the gap is 0 throughout."),
      injectionLines(found).map((line) => el("p", {}, line)),
      causes(found),
      found.parting && found.parting.common_steps > 0 ? settings(found) : null,
    );
  }
  close() {
    this.chart?.close();
  }
}
