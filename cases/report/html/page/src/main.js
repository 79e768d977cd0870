// The page: the first screen or one case, as the address says.
import { loadResults } from "./data.js";
import { el, replace } from "./dom.js";
import { CaseView } from "./case_view.js";
import { Overview } from "./overview.js";
import { openHelp } from "./help.js";
import { divergence, firstView } from "./parting_view.js";
import { applyTheme, themeButton } from "./theme.js";
import { address, addressOfAll, followAddress, onChange, openAll, site, state } from "./state.js";

const page = document.getElementById("page");

function header(results) {
  const { cases, engines } = results;
  const count = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;
  return el(
    "header.top",
    {},
    el(
      "a.brand",
      {
        href: addressOfAll(),
        onclick: (event) => (event.preventDefault(), openAll()),
      },
      "Rigor",
    ),
    el(
      "span.tagline",
      {},
      `${count(cases.length, "case")} · ${count(new Set(engines.map((e) => e.name.split(/[:@,]/)[0])).size, "engine")} · ${count(engines.length, "method and setting")}`.replace(
        "method and settings",
        "methods and settings",
      ),
    ),
    el("span.spacer"),
    el("button.quiet", { type: "button", title: "Keys (?)", onclick: openHelp, "aria-label": "Keys and help" }, "?"),
    site ? null : themeButton(), // a site's other pages follow the system
  );
}

// Each engine's colour, in light and dark, under a name that style sheets can use.
function engineColours(engines) {
  const of = (which) => engines.map((e) => `--e${e.index}:${e.colours[which]}`).join(";");
  return el("style", {}, `:root{${of(0)}}:root[data-theme="dark"]{${of(1)}}`);
}

function unknownCase(results) {
  return el(
    "section",
    {},
    el("h1", {}, "No such case"),
    el("p", {}, `This report has no case “${state.case}”. `, el("a", { href: addressOfAll() }, "All cases")),
  );
}

async function start() {
  applyTheme();
  if (typeof DecompressionStream === "undefined") {
    replace(
      page,
      el(
        "p",
        {},
        "This browser is too old for the report: it lacks DecompressionStream (Chrome 80, Firefox 113, Safari 16.4). Read report.md instead.",
      ),
    );
    return;
  }
  const results = await loadResults();
  document.head.append(engineColours(results.engines));
  if (divergence && !location.hash) history.replaceState(null, "", address(firstView()));
  followAddress(site ? results.cases[0].id : "");
  let view = null;
  const show = () => {
    view?.close();
    const one = results.caseById.get(state.case);
    const body = el("div.view");
    replace(page, header(results), body);
    view = null;
    if (!state.case) view = new Overview(results, body);
    else if (one) view = new CaseView(results, one, body);
    else replace(body, unknownCase(results));
    window.scrollTo(0, 0);
  };
  onChange((changed) => {
    if (changed.has("case")) show();
  });
  window.addEventListener("keydown", (event) => {
    const isTyping = event.target.closest?.("input, select, textarea, dialog");
    if (isTyping || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "?") openHelp();
    else if (view?.key?.(event)) event.preventDefault();
  });
  window.addEventListener("beforeprint", () => {
    applyTheme("light");
    for (const folded of document.querySelectorAll(".answers details")) folded.open = true;
  });
  window.addEventListener("afterprint", () => applyTheme());
  show();
  await view?.whole;
  document.documentElement.dataset.ready = "true";
}

start().catch((error) => {
  console.error(error);
  replace(
    page,
    el("p", {}, `The report could not be shown: ${error.message}. report.md and results.json say the same.`),
  );
});
