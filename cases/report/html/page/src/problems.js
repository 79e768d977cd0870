// The problems that were found, ranked by consequence: a headline and bars that compare the engines, and the sentences
// behind a click. The bars are the facts that the sentences state.
import { el } from "./dom.js";
import { digits, percent, quantity, words } from "./format.js";
import { address, openCase } from "./state.js";

const shownAtFirst = 6;
const mostBars = 6;

const headlines = {
  recorded: "How near each engine comes to the recording",
  "stiff springs": "Stiff springs: who stays bounded",
  "step size": "The largest step within 1 mm",
  energy: "Energy that is lost or gained",
  friction: "Friction that depends on direction",
  impacts: "Bounces and overlaps that do not converge",
  "contact-forces": "Contact forces that spike, creep or hover",
  joints: "Joints that open",
  stability: "Motions that blow up",
  sampling: "Energy read half a step late",
  unexplained: "Errors that no scheme explains",
};

const factNames = {
  "stiff cells that blew up": "runs with stiff springs that blew up",
  "largest step for a tolerance": "largest step with a typical error within 1 mm",
  "cells that blew up": "runs that blew up",
};

// How large a fact is in words, where the sentence does not print it.
const units = { "largest unexplained_error": "m" };
const isShare = (quantity) => /energy|anisotropy|share/.test(quantity);
const stepOf = (claim) => (claim.quantity === "largest step for a tolerance" ? (claim.dt ? `${claim.dt} s` : "none") : null);
const told = (claim) =>
  (stepOf(claim) ?? claim.printed?.replace(/^-/, "−")) ??
  (isShare(claim.quantity) ? percent(claim.value) : null) ?? (units[claim.quantity] ? quantity(claim.value, units[claim.quantity]) : digits(claim.value, 2));

export function problems(results) {
  const { findings } = results;
  const shown = findings.filter((found) => found.topic !== "recommendation"); // the headline of the page
  if (!shown.length) return null;
  const problem = problemOf(results);
  const rest = shown.slice(shownAtFirst);
  return el(
    "section.part.problems",
    { id: "problems" },
    el("h2", {}, "Problems and facts"),
    el("div.answers", {}, shown.slice(0, shownAtFirst).map(problem)),
    rest.length
      ? el("details.more-problems", {}, el("summary", {}, `${rest.length} more`), el("div.answers", {}, rest.map(problem)))
      : null,
  );
}

function problemOf(results) {
  const link = (id, text = id) =>
    el("a", { href: address({ case: id }), onclick: (event) => (event.preventDefault(), openCase(id)) }, text);
  // Names of cases lead to them.
  const linked = (text) =>
    text.split(/([\w.-]+(?:\/[\w.-]*\w)+)/).map((part) => (results.caseById.has(part) ? link(part) : part));
  return ({ topic, text, more, claims = [] }) => {
    const bars = barsOf(results, claims, link);
    return el(
      "section.answer",
      {},
      el("h3", {}, headlines[topic] ?? topic),
      bars,
      el(
        "details",
        { open: !bars },
        el("summary", {}, "in words"),
        el("p.text", {}, linked(text)),
        more ? el("p.more", {}, linked(more)) : null,
      ),
    );
  };
}

// " at 1/30 s" where all facts are of one step.
const atStep = (claims) => {
  const steps = new Set(claims.map((claim) => (stepOf(claim) ? "" : claim.dt ?? "")));
  const [step] = steps;
  return steps.size === 1 && step ? ` at ${step} s` : "";
};

// A bar for each engine, of the fact that most engines share: external engines first, the largest first.
function barsOf(results, claims, link) {
  const byQuantity = new Map();
  for (const claim of claims) {
    if (!claim.engine || typeof claim.value !== "number") continue;
    const rows = byQuantity.get(claim.quantity) ?? new Map();
    if (!rows.has(claim.engine)) rows.set(claim.engine, claim);
    byQuantity.set(claim.quantity, rows);
  }
  const [fact, shared] = [...byQuantity].sort((a, b) => b[1].size - a[1].size)[0] ?? [];
  if (!shared || shared.size < 2) return null;
  const of = (name) => results.engines.find((e) => e.name === name);
  const rows = [...shared.values()].filter((claim) => of(claim.engine));
  rows.sort((a, b) => of(a.engine).core - of(b.engine).core || Math.abs(b.value) - Math.abs(a.value));
  const largest = Math.max(...rows.map((r) => Math.abs(r.value)), 1e-300);
  return el(
    "table.bars",
    {},
    el("caption", {}, factNames[fact] ?? words(fact), atStep(rows)),
    el(
      "tbody",
      {},
      rows.slice(0, mostBars).map((claim) =>
        el(
          "tr",
          {},
          el("th", { scope: "row" }, claim.engine),
          el(
            "td.bar-cell",
            {},
            el("span.level", {
              style: { width: `${(100 * Math.abs(claim.value)) / largest}%`, "--engine": `var(--e${of(claim.engine).index})` },
            }),
          ),
          el("td", {}, told(claim)),
          el("td.where", {}, claim.case ? link(claim.case, claim.case.split("/").pop()) : ""),
        ),
      ),
    ),
  );
}
