// Formulas in an explanation, set in MathML with the numbers of this run.
import { typeset } from "./dom.js";
import { digits } from "./format.js";

const make = (tag, ...children) => {
  const node = document.createElementNS("http://www.w3.org/1998/Math/MathML", tag);
  node.append(...children.flat(Infinity));
  return node;
};
const mi = (text) => make("mi", text),
  mn = (text) => make("mn", String(text)),
  mo = (text) => make("mo", text),
  mtext = (text) => make("mtext", text),
  fraction = (above, below) => make("mfrac", make("mrow", above), make("mrow", below)),
  step = () => [mo("Δ"), mi("t")],
  math = (...children) => make("math", children);

// "1/30" as a fraction.
const stepValue = (text) => {
  const [above, below] = text.split("/");
  return below ? fraction(mn(above), mn(below)) : mn(text);
};
const dtIn = (text) => /\bdt = ([\d./e-]+) s/.exec(text)?.[1];

// A pattern in the text, and the formula that replaces it. `whole` is the explanation.
const rules = [
  [
    /g dt t\/2 = ([\d.]+ \S*m)\b/,
    ([, result], { whole, scene }) => {
      const g = Math.hypot(...scene.gravity),
        dt = dtIn(whole);
      const numbers = dt ? [mo("="), fraction([mn(digits(g)), mtext(" m/s²"), mo("·"), stepValue(dt), mtext(" s"), mo("·"), mn(1), mtext(" s")], mn(2))] : [];
      return math(fraction([mi("g"), mo("·"), step(), mo("·"), mi("t")], mn(2)), numbers, mo("="), mtext(result));
    },
  ],
  [
    /ω = ([\d.e+]+)( rad\/s)?, so ω dt = ([\d.e+]+) at dt = ([\d./e-]+) s/,
    ([, omega, unit = " rad/s", result, dt]) =>
      math(mi("ω"), mo("·"), step(), mo("="), mn(omega), mtext(unit), mo("·"), stepValue(dt), mtext(" s"), mo("="), mn(result)),
  ],
  [
    /c dt\/(\w) = ([\d.e+]+)/,
    ([, inertia, result]) => math(fraction([mi("c"), mo("·"), step()], mi(inertia)), mo("="), mn(result)),
  ],
  [/\|RᵀR − I\|/, () => math(mo("|"), make("msup", mi("R"), mi("T")), mi("R"), mo("−"), mi("I"), mo("|"))],
  [/sqrt\((\d+)\)/, ([, of]) => math(make("msqrt", mn(of)))],
];

export function withFormulas(text, scene, whole = text) {
  for (const [pattern, formula] of rules) {
    const found = pattern.exec(text);
    if (!found) continue;
    const before = text.slice(0, found.index),
      after = text.slice(found.index + found[0].length);
    return [...withFormulas(before, scene, whole), formula(found, { whole, scene }), ...withFormulas(after, scene, whole)];
  }
  return typeset(text);
}
