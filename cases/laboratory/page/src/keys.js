// The keys, in a dialog.
import { el } from "../../../report/html/page/src/dom.js";

const keys = [
  ["space", "play, pause"],
  ["→", "one step"],
  ["r", "back to the start"],
  ["+ −", "faster, slower"],
  ["< >", "smaller, larger dt"],
  ["o s", "overlaid, side by side"],
  ["g", "the truth as a ghost"],
  ["l", "logarithmic or linear plots"],
  ["f", "the whole scene in the picture"],
];

export function openKeys() {
  const dialog = el(
    "dialog",
    { "aria-label": "Keys" },
    el("h2", {}, "Keys"),
    el(
      "dl",
      {},
      keys.map(([key, does]) => [el("dt", {}, el("kbd", {}, key)), el("dd", {}, does)]),
    ),
    el(
      "p.fine",
      {},
      "Drag the picture to turn it. Drop a case file anywhere on the page. The address holds all that is chosen: send it to show the same.",
    ),
    el("form", { method: "dialog" }, el("button", { type: "submit" }, "Close")),
  );
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}
