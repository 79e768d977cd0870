// The page: it starts the laboratory as soon as the simulators are there.
import { el, replace } from "../../../report/html/page/src/dom.js";
import { applyTheme, themeButton } from "../../../report/html/page/src/theme.js";
import { App } from "./app.js";
import { openKeys } from "./keys.js";
import { carriedCases, compile } from "./simulators.js";

const page = document.getElementById("page");

// The shortest modules with a vector of doubles, and with an exception.
const withVectors = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11];
const withException = [0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 10, 8, 1, 6, 0, 6, 64, 25, 11, 11];
const takes = (bytes) => typeof WebAssembly !== "undefined" && WebAssembly.validate(new Uint8Array(bytes));

const lacking = () =>
  [
    [typeof WebAssembly === "undefined", "WebAssembly"],
    [!takes(withVectors), "WebAssembly's vector instructions (Chrome 91, Firefox 89, Safari 16.4)"],
    [!takes(withException), "WebAssembly's exceptions (Chrome 95, Firefox 100, Safari 15.2)"],
    [typeof DecompressionStream === "undefined", "DecompressionStream (Chrome 80, Firefox 113, Safari 16.4)"],
  ]
    .filter(([lacks]) => lacks)
    .map(([, name]) => name);

// The page with engines of the npm registry, or back to the smaller one; with the same state.
function otherPage() {
  const link = JSON.parse(document.getElementById("rigor-link")?.textContent ?? "null");
  if (!link) return null;
  return el(
    "a.quiet",
    { id: "other-page", href: link.file, title: link.title, onclick: (event) => (event.target.href = link.file + location.hash) },
    link.text,
  );
}

async function start() {
  applyTheme();
  const lacks = lacking();
  if (lacks.length > 0) throw new Error(`this browser is too old for it: it lacks ${lacks.join(" and ")}`);
  compile(); // takes longest
  const body = el("main.view");
  const app = new App(body, await carriedCases());
  replace(
    page,
    el(
      "header.top",
      {},
      el("span.brand", {}, "Rigor"),
      el("span.tagline", {}, "A laboratory for the steps of rigid-body simulators"),
      el("span.spacer"),
      otherPage(),
      el(
        "button.quiet",
        { type: "button", id: "keys", title: "Keys (?)", "aria-label": "Keys and help", onclick: openKeys },
        "?",
      ),
      themeButton(),
    ),
    body,
  );
  await app.start();
  window.addEventListener("keydown", (event) => {
    const isTyping = event.target.closest?.("input, select, textarea, dialog");
    if (isTyping || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "?") openKeys();
    else if (app.key(event)) event.preventDefault();
  });
  document.documentElement.dataset.ready = String(Math.round(performance.now()));
}

start().catch((error) => {
  console.error(error);
  replace(page, el("p.error", {}, `The laboratory could not be started: ${error.message}.`));
});
