// Numbers as people read them.
const prefixes = [
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
  [1e-12, "p"],
];
const superscripts = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

export const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

// Three digits; 1.2·10⁵ where that would be long.
export function digits(value, count = 3) {
  if (!isNumber(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-4) {
    const exponent = Math.floor(Math.log10(size));
    const mantissa = (value / 10 ** exponent).toPrecision(Math.min(count, 2)).replace(/\.?0+$/, "");
    return `${mantissa}·10${power(exponent)}`.replace("-", "−");
  }
  return String(Number(value.toPrecision(count))).replace("-", "−");
}

export const power = (exponent) => [...String(exponent)].map((c) => superscripts[c]).join("");

// Two digits unless more are asked for, with the unit: 30 mm, 0.46 rad, 27 %.
export function quantity(value, unit, count = 2) {
  if (!isNumber(value)) return "–";
  if (unit === "1") return percent(value, count);
  if (unit !== "m" && unit !== "rad" && unit !== "s") return unit ? `${digits(value, count)} ${unit}` : digits(value, count);
  const size = Math.abs(value);
  if (size < 1e-12) return value === 0 ? "0" : "≈ 0";
  if (size >= 1e4) return `${digits(value, count)} ${unit}`;
  const [factor, prefix] = prefixes.find(([f]) => size >= f * 0.9995) ?? prefixes.at(-1);
  return `${digits(value / factor, count)} ${prefix}${unit}`;
}

export function percent(value, count = 2) {
  if (!isNumber(value)) return "–";
  const size = Math.abs(100 * value);
  if (size < 1e-9) return value === 0 ? "0 %" : "≈ 0 %";
  return `${digits(100 * value, count)} %`;
}

export const seconds = (value, count = 2) => `${value.toFixed(count)} s`;

// Of an engine that holds its numbers in single precision.
export const singleTitle =
  "single precision, 24 bits: the limits of its gates include the effect of rounding";

// "position error" of "position_error".
export const words = (name) => name.replaceAll("_", " ");

// An engine's name on two lines: the engine, then its method.
export function engineParts(name) {
  const at = name.indexOf(":");
  return at < 0 ? [name, ""] : [name.slice(0, at), name.slice(at + 1)];
}
