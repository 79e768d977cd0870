// Pictures and numbers as files.
import { el } from "./dom.js";

export function savedAs(name, text) {
  const type = name.endsWith(".svg") ? "image/svg+xml" : "text/csv";
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// With the colours and fonts that the page's style gives it, so that it looks the same by itself.
export function svgText(picture) {
  const copy = picture.cloneNode(true);
  const parts = [picture, ...picture.querySelectorAll("*")],
    copies = [copy, ...copy.querySelectorAll("*")];
  const kept = ["fill", "stroke", "stroke-width", "stroke-dasharray", "opacity", "font-size", "font-weight", "font-family"];
  parts.forEach((part, i) => {
    const style = getComputedStyle(part);
    copies[i].setAttribute("style", kept.map((key) => `${key}:${style.getPropertyValue(key)}`).join(";"));
  });
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  return new XMLSerializer().serializeToString(copy);
}

// "a ""b""" where a comma or a quotation mark would end a field.
const field = (value) => (/[",\n]/.test(String(value ?? "")) ? `"${String(value).replaceAll('"', '""')}"` : String(value ?? ""));
export const csvText = (head, rows) => [head, ...rows].map((row) => row.map(field).join()).join("\n") + "\n";

// Buttons that save a plot. `picture` returns an SVG element or its text, `table` the head and the rows.
export function saveButtons(name, picture, table) {
  const button = (kind, text) =>
    el("button.quiet.save", { type: "button", "aria-label": `Save ${name} as ${kind}`, onclick: () => savedAs(`${name}.${kind.toLowerCase()}`, text()) }, kind);
  const drawn = () => {
    const found = picture();
    return typeof found === "string" ? found : svgText(found);
  };
  return el("span.saves", {}, button("SVG", drawn), button("CSV", () => csvText(...table())));
}
