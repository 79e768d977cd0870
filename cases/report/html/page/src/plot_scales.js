// The vertical scales of a plot: how values map to it, its range, and the positions and labels of its ticks.
import { percent, power, quantity } from "./format.js";

// Decades; zero lies on a separate line below the smallest value, marked 0.
export function logarithmic(series) {
  let smallest = Infinity,
    largest = 0,
    hasZero = false;
  for (const values of series) {
    for (const value of values) {
      const size = Math.abs(value);
      if (size > 1e-17 && size < smallest) smallest = size;
      if (size <= 1e-17) hasZero = true;
      if (size > largest) largest = size;
    }
  }
  if (!(largest > 0) || smallest === Infinity) smallest = largest = 1;
  const top = Math.ceil(Math.log10(largest) + 0.05),
    bottom = Math.max(Math.floor(Math.log10(smallest)), top - 18);
  const floor = hasZero || Math.log10(smallest) < bottom ? bottom - 1 : bottom;
  const step = Math.max(1, Math.ceil((top - bottom) / 5));
  const splits = [];
  for (let e = top; e > floor; e -= step) splits.unshift(e);
  if (floor < bottom) splits.unshift(floor);
  return {
    put: (value) =>
      Number.isNaN(value) ? null : Math.max(floor, Math.abs(value) > 1e-17 ? Math.log10(Math.abs(value)) : floor),
    range: () => [floor - 0.1, top],
    splits: () => splits,
    tick: (value) => (value === floor && floor < bottom ? "0" : `10${power(value)}`),
  };
}

export function linear(unit, fixed) {
  return {
    put: (value) => (Number.isNaN(value) ? null : value),
    range: (u, min, max) => {
      if (fixed && (min < fixed[0] || max > fixed[1])) return fixed;
      if (min === null || max === null) return [0, 1];
      const pad = 0.08 * (max - min) || Math.max(1e-12, 0.1 * Math.abs(max)) || 1;
      return [min - pad, max + pad];
    },
    splits: undefined,
    tick: (value) => (unit === "1" ? percent(value) : quantity(value, unit)),
  };
}
