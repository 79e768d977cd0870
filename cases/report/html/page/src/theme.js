// Light or dark: as the system says, until the reader says otherwise.
import { el } from "./dom.js";
import { site } from "./state.js";

const listeners = new Set();
const system = matchMedia("(prefers-color-scheme: dark)");
let chosen = site ? null : read(); // a site's other pages follow the system

function read() {
  try {
    return localStorage.getItem("rigor-theme");
  } catch {
    return null;
  }
}

let forced = null;
export const isDark = () => (forced ?? chosen ?? (system.matches ? "dark" : "light")) === "dark";

// `only`: a theme for as long as it lasts, for printing.
export function applyTheme(only = null) {
  forced = only;
  document.documentElement.dataset.theme = isDark() ? "dark" : "light";
  for (const listener of listeners) listener();
}
system.addEventListener("change", () => applyTheme());

export function onTheme(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export function themeButton() {
  const button = el(
    "button.quiet",
    { type: "button", title: "Light or dark", "aria-label": "Switch between light and dark" },
    "◐",
  );
  button.addEventListener("click", () => {
    chosen = isDark() ? "light" : "dark";
    try {
      localStorage.setItem("rigor-theme", chosen);
    } catch {
      /* only for this visit then */
    }
    applyTheme();
  });
  return button;
}

// A colour of the style sheet, for canvases.
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
