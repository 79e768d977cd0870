// Sentences for the findings of `rigor diverge`, from the data of divergence.json.
import { digits, isNumber, percent, quantity } from "./format.js";

const isOneEngine = ({ a, b }) => a.run === b.run;
// With the step only where that alone tells the two runs apart.
export const nameOf = (found, run) => (isOneEngine(found) ? `${run.run} at ${run.dt} s` : run.run);
export const swapText = (found, swap) =>
  swap.swaps.map(({ of, setting }) => `${setting.replace(" -> ", " → ")} of ${nameOf(found, found[of])}`).join(" and ");

// JSON has no infinity: null stands for it.
const orInfinity = (share) => share ?? Infinity;
const largestOf = ({ gap }) => gap.share.reduce((most, share, i) => (orInfinity(share) > orInfinity(gap.share[most]) ? i : most), 0);

// The gap exceeds the bound, but repeats of one run differ too much for it to count.
const isWithinSpread = (found) => !found.parting && orInfinity(found.largest_share) > 1;

export function title(found) {
  const pair = `${nameOf(found, found.a)} and ${nameOf(found, found.b)}`;
  if (found.parting) return `${pair} part at ${digits(found.parting.time, 4)} s`;
  return isWithinSpread(found) ? `${pair} leave the bound, but so do their repeats` : `${pair} do not part`;
}

function neverParted(found) {
  const at = largestOf(found),
    time = found.gap.time[at];
  if (isWithinSpread(found)) {
    const spread = Math.max(found.a.spread, found.b.spread);
    return `The gap reaches ${digits(found.largest_share)} of the bound, at ${digits(time, 4)} s. Repeats of one run differ by up to ${digits(spread)} of the bound. A gap counts only beyond three times what repeats differ by.`;
  }
  if (found.largest_share === 0) return `The gap is 0 at each of the instants compared, in ${digits(found.compared)} s.`;
  return `In ${digits(found.compared)} s the gap is at most ${digits(found.largest_share)} of the bound, at ${digits(time, 4)} s.`;
}

function whereParted({ parting }) {
  const { body, component, unit } = parting;
  const values = isNumber(parting.a) ? ` (${digits(parting.a, 6)} against ${digits(parting.b, 6)} ${unit})` : "";
  return `“${body}” is then ${quantity(parting.gap, unit, 3)} apart, most in ${component}${values}. The bound is ${quantity(parting.bound, unit, 3)}.`;
}

// Names the run that is nearer the truth, if the truth is exact enough to tell.
function judged(found) {
  const { truth, parting } = found;
  if (truth.none !== undefined) return `No truth says which run is right: ${truth.none}.`;
  const away = (run, distance) => `${nameOf(found, run)} is ${quantity(distance, parting.unit, 3)} from the truth`;
  const both = `${away(found.a, truth.a)}, ${away(found.b, truth.b)}.`;
  const own = ["a", "b"].filter((key) => truth[`${key}_is_made_by_it`]).map((key) => nameOf(found, found[key]));
  const caveat = own.length ? ` The truth is made by the code of ${own.join(" and of ")}.` : "";
  const nearer = truth.nearer ? ` ${nameOf(found, found[truth.nearer])} is nearer.` : " The truth is not exact enough to say which is nearer.";
  return both + nearer + caveat;
}

// The answer, one sentence a line.
export function answerLines(found) {
  const ended = found.ended ? `${found.ended}; both are compared until then.` : null;
  if (!found.parting) return [neverParted(found), ended].filter(Boolean);
  return [whereParted(found), judged(found), ended].filter(Boolean);
}

export function stepsNote({ a, b }) {
  return a.dt === b.dt ? null : `The picture shows one step size at a time. The buttons “dt” above it switch between ${a.dt} s and ${b.dt} s.`;
}

function hidden(found, key) {
  const most = Math.max(...found.injections.steps.map((step) => step[`hidden_${key}`]));
  return most < 1e-9 ? `${nameOf(found, found[key])} hides nothing` : `${nameOf(found, found[key])} hides up to ${digits(most)} of the bound`; // roundings alone reach 1e-9
}

// How the gap comes about.
export function injectionLines(found) {
  const { injections, parting } = found;
  if (!parting) return [];
  if (parting.common_steps === 0) return ["The engines start in different states, so no step was looked at."];
  if (!injections.steps.length) return [`What each step adds was not measured: ${injections.why}.`];
  const share = injections.injected,
    isTakenBack = share < 0 || share > 1.05 ? " The motion takes part of these differences back." : "";
  const some = injections.all_steps ? "" : ` ${injections.steps.length} of ${parting.common_steps} steps were measured.`;
  return [
    `Both engines make one step from the same state. Free motion of all these one-step differences makes ${percent(share, 3)} of the gap.${isTakenBack}${some}`,
    `A small nudge grows ${digits(injections.growth_factor)} times until the runs part.`,
    `A world that runs against a fresh one: ${hidden(found, "a")}, ${hidden(found, "b")}.`,
  ];
}

export function reason(cause) {
  if (cause.why) return cause.why;
  if (cause.rounding) return "rounding";
  if (!cause.part) return "no single part of the scene";
  return cause.part + (cause.detail ? ` (${cause.detail})` : "");
}
export const isNamed = (cause) => !cause.why && !cause.rounding && Boolean(cause.part);

export const falls = (cause) =>
  isNumber(cause.at_half_step) ? `${cause.falls_with_dt ? "yes" : "no"}: ${digits(cause.at_half_step, 2)} of it at half the step` : "not measured";

export function settingLine(found) {
  if (found.setting) {
    const { closes, closes_at_half_step: half } = found.setting;
    const atHalf = isNumber(half) ? `${percent(half, 3)} at half the step` : "and at half the step there is no gap";
    return `${swapText(found, found.setting)} closes ${percent(closes, 3)} of the gap, ${atHalf}.`;
  }
  if (!found.differing_settings) return "No setting differs between the runs.";
  if (!found.swaps.length) return "No setting that differs can be changed here.";
  return "No setting closes half of the gap at this step and at half of it.";
}
