// The problems that were found, ranked by consequence: a headline each, and the reason behind a click.
import { el } from "./dom.js";
import { address, openCase } from "./state.js";

const shownAtFirst = 6;

export function problems(results) {
  const { findings } = results;
  if (!findings.length) return null;
  const link = (id) =>
    el("a", { href: address({ case: id }), onclick: (event) => (event.preventDefault(), openCase(id)) }, id);
  // Names of cases lead to them.
  const linked = (text) =>
    text.split(/([\w.-]+(?:\/[\w.-]*\w)+)/).map((part) => (results.caseById.has(part) ? link(part) : part));
  const problem = ({ topic, text, more }) =>
    el(
      "section.answer",
      {},
      el("h3", {}, topic),
      el("p.text", {}, linked(text)),
      more ? el("details", {}, el("summary", {}, "why, and who else"), el("p.more", {}, linked(more))) : null,
    );
  const rest = findings.slice(shownAtFirst);
  return el(
    "section.part.problems",
    { id: "problems" },
    el("h2", {}, "Problems and facts"),
    el("div.answers", {}, findings.slice(0, shownAtFirst).map(problem)),
    rest.length
      ? el("details.more-problems", {}, el("summary", {}, `${rest.length} more`), el("div.answers", {}, rest.map(problem)))
      : null,
  );
}
