// A slider with its label and its value as text.
import { el } from "../../../report/html/page/src/dom.js";

// The text follows while the slider moves; the scene follows when it is let go, or a moment after.
export function slider({ id, label, text, min, max, step, value, isOff = false, set, show }) {
  const output = el("output", { for: id }, text);
  let waiting = 0;
  const input = el("input", {
    ...{ type: "range", id, min, max, step, "aria-valuetext": text, disabled: isOff },
    oninput: (event) => {
      const now = Number(event.target.value);
      output.textContent = show(now);
      event.target.setAttribute("aria-valuetext", show(now));
      clearTimeout(waiting);
      waiting = setTimeout(() => set(now), 250);
    },
  });
  input.value = String(value);
  return el("div.slider", {}, el("label", { for: id }, label), output, input);
}
