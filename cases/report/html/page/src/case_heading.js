// The head of a case's page: its path, its question with a sketch, its answer, its truth, and why.
import { el } from "./dom.js";
import { withFormulas } from "./formulas.js";
import { digits, quantity } from "./format.js";
import { questionOf } from "./question.js";
import { sceneSketch } from "./scene_sketch.js";
import { address, addressOfAll, openAll, site } from "./state.js";

function truthText({ truth, duration }) {
  if (truth.kind === "none") return "No truth: only stability and what is conserved are judged.";
  if (truth.kind === "recording" && truth.horizon !== undefined) return "Truth: a recording.";
  if (truth.horizon === undefined) return `Truth: ${truth.kind}, not found.`;
  if (truth.horizon >= duration)
    return `Truth: ${truth.kind}; its own error is at most ${digits(truth.error_at_end, 2)} m or rad over the whole ${digits(duration)} s.`;
  return `Truth: ${truth.kind}; known to ${quantity(truth.horizon_tolerance, "m")} up to its horizon at ${truth.horizon.toFixed(1)} s of ${digits(duration)} s, and compared only so far: beyond it ${truth.caveat ? "it is not known" : "the motion is too sensitive"}.`;
}

function aboutTruth(one) {
  const { truth } = one;
  return el(
    "details.about-truth",
    {},
    el("summary", {}, truthText(one) + (truth.caveat ? ` ${truth.caveat}` : "")),
    el(
      "p.truth",
      {},
      truth.provenance ? ` It is ${truth.provenance}.` : "",
      one.source ? el("span.source", {}, ` Source: ${one.source}.`) : null,
    ),
  );
}

// A link to the case at `at`, which may be beyond either end of the list; in a site to another page.
function step(page, at, sign, label, elsewhere) {
  if (elsewhere) return el("a.quiet", { href: elsewhere.address, title: elsewhere.id, "aria-label": label }, sign);
  const other = page.results.cases[at];
  if (!other) return el("span.quiet.is-off", {}, sign);
  return el(
    "a.quiet",
    {
      href: address({ case: other.id, time: 0, zoom: null, engines: null }),
      title: other.id,
      "aria-label": label,
      onclick: (event) => (event.preventDefault(), page.goTo(at)),
    },
    sign,
  );
}

function path(page) {
  const { one, results } = page,
    at = results.cases.indexOf(one);
  const toAll = (event) => (event.preventDefault(), openAll());
  return el(
    "p.path",
    {},
    el("a", { href: addressOfAll(), onclick: toAll }, "All cases"),
    " / ",
    one.id,
    el("span.steps", {}, step(page, at - 1, "‹", "The case before", site?.before), step(page, at + 1, "›", "The next case", site?.after)),
  );
}

function why(one) {
  if (!one.explanations.length) return null;
  return el(
    "details.why",
    { open: true },
    el("summary", {}, el("h2", {}, "Why")),
    el("ul.findings", {}, one.explanations.map((text) => el("li", {}, withFormulas(text, one.scene)))),
  );
}

// page: results, one (the case), answer (the element of its answer), goTo(place of a case in results).
export function caseHeading(page) {
  const { one } = page;
  return el(
    "section.heading",
    {},
    path(page),
    el(
      "div.beside-sketch",
      {},
      el(
        "div",
        {},
        el("p.question", {}, one.title || one.id),
        el("p.asks", {}, withFormulas(questionOf(one), one.scene)),
        page.answer,
      ),
      sceneSketch(one.scene),
    ),
    one.error ? el("p.error", {}, one.error) : null,
    aboutTruth(one),
    why(one),
  );
}
