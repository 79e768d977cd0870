// The keys, in a dialog.
import { el } from "./dom.js";

const keys = [
  ["space", "play or pause"],
  ["← →", "one step back or on; with shift ten"],
  ["home end", "to the start, to the end"],
  ["1 … 9, 0", "an engine on or off; with shift alone"],
  ["a  n", "all engines, none"],
  ["o  s", "overlaid or side by side"],
  ["g t c i e", "the truth, trails, contacts, joints, forces"],
  ["+ −", "faster, slower"],
  ["f", "the whole scene in the picture"],
  ["l", "plots logarithmic or linear"],
  ["z", "the whole time in the plots"],
  ["d", "the next step size"],
  [", .", "the trial before, the next one"],
  ["j k", "the next case, the one before"],
  ["esc", "all cases"],
  ["?", "this"],
];

export function openHelp() {
  document.querySelector("dialog.help")?.remove();
  const dialog = el(
    "dialog.help",
    { "aria-label": "Keys" },
    el("h2", {}, "Keys"),
    el(
      "dl",
      {},
      keys.map(([key, meaning]) => [el("dt", {}, key), el("dd", {}, meaning)]),
    ),
    el(
      "p",
      {},
      "In the picture: drag to turn, pinch or ctrl and wheel to come closer, shift and drag to move. " +
        "In a plot: move to set the time, drag to zoom, double click for the whole. " +
        "In the matrix the arrow keys go from cell to cell. The address always says what is looked at.",
    ),
    el("form", { method: "dialog" }, el("button", {}, "Close")),
  );
  document.body.append(dialog);
  dialog.addEventListener("close", () => dialog.remove());
  dialog.showModal();
}
