// Error against cost of each run, over many cases, and the step that a tolerance takes. The curves come from
// results.json; for another tolerance the page only reads another point off them.
import { isHeldToItself, judgement, metricOf } from "./data.js";
import { isNumber } from "./format.js";

const mostFailed = 0.05; // the share of failed cases up to which a step may be recommended

// The number of steps per simulated second stands for the cost where nothing was timed.
export function curvesOf(results, family) {
  const scope = (results.frontier ?? []).find((s) => s.family === family) ?? results.frontier?.[0];
  const timed = isTimed(results);
  const worked = (points) => points.map((p) => ({ ...p, cost: timed ? p.cost : 1 / p.dt_seconds }));
  return (scope?.curves ?? [])
    .map((curve) => ({
      ...curve,
      run: results.engines.find((e) => e.name === curve.engine),
      points: worked(curve.points).filter((p) => p.cost > 0),
    }))
    .filter((curve) => curve.run && curve.points.some((p) => isNumber(p.mean)));
}

// The same of one case: each step is one cell.
export function curvesOfCase(results, one) {
  const reference = new Set((results.frontier?.[0]?.curves ?? []).filter((c) => c.reference).map((c) => c.engine));
  const timed = isTimed(results);
  return results.engines
    .map((run) => {
      const cells = one.cells.filter((c) => c.engine === run.name && c.status !== "unsupported" && !isHeldToItself(c, one.main));
      const points = cells.map((cell) => {
        const failed = judgement(cell).kind === "bad" && cell.status !== "fail";
        const error = failed ? null : metricOf(cell, one.main);
        const cost = timed ? cell.cpu_seconds / one.duration : 1 / cell.dt_seconds;
        return { dt: cell.dt, dt_seconds: cell.dt_seconds, cases: 1, failed: Number(failed), mean: error, median: error, low: error, high: error, cost };
      });
      const sorted = points.filter((p) => p.failed || p.mean !== null).sort((a, b) => b.dt_seconds - a.dt_seconds);
      return { engine: run.name, run, reference: reference.has(run.name), points: sorted };
    })
    .filter((curve) => curve.points.some((p) => isNumber(p.mean) && p.cost > 0));
}

export const isTimed = (results) =>
  (results.frontier ?? []).some((s) => s.curves.some((c) => c.points.some((p) => p.cost > 0)));

export const families = (results) => (results.frontier ?? []).map((scope) => scope.family).filter(Boolean);

const mostCases = (curve) => Math.max(...curve.points.map((p) => p.cases));
export const mayBeTaken = (point) => point.failed <= mostFailed * point.cases;
// Both the mean and the median case: a few exact cases must not hide the error of most.
export const meets = (point, tolerance) =>
  [point.mean, point.median].every((error) => isNumber(error) && error <= tolerance) && mayBeTaken(point);

// The cheapest step of these curves within the tolerance, of runs that compare at least half as many cases as any.
export function cheapest(curves, tolerance, among = () => true) {
  const most = Math.max(0, ...curves.map(mostCases));
  let best = null;
  for (const curve of curves.filter(among)) {
    for (const point of curve.points) {
      if (!meets(point, tolerance) || 2 * point.cases < most || !(point.cost > 0)) continue;
      if (!best || point.cost < best.point.cost) best = { curve, point };
    }
  }
  return best;
}

export const isExternal = (curve) => !curve.run.core;
export const isCoreMethod = (curve) => curve.run.core && !curve.reference;
export const isReference = (curve) => curve.reference;

// The largest step of a curve that is within the tolerance, or null.
export const largestStep = (curve, tolerance) =>
  curve.points.filter((p) => meets(p, tolerance)).sort((a, b) => b.dt_seconds - a.dt_seconds)[0] ?? null;

// One curve for each engine: its first run on the track `matched`; of the core the cheapest method within the
// tolerance, else the one that errs least; and the cheapest reference. Runs of few cases are not compared with these.
export function mainCurves(all, tolerance) {
  const most = Math.max(0, ...all.map(mostCases));
  const curves = all.filter((c) => 2 * mostCases(c) >= most);
  const firsts = new Map();
  for (const curve of curves.filter(isExternal)) {
    const engine = engineOf(curve);
    if (!firsts.has(engine) || firsts.get(engine).run.stock) firsts.set(engine, curve);
  }
  const leastError = (curve) => Math.min(...curve.points.map((p) => p.mean ?? Infinity));
  const best = (among) => [...curves.filter(among)].sort((a, b) => leastError(a) - leastError(b))[0];
  const pick = (among) => cheapest(curves, tolerance, among)?.curve ?? best(among);
  return [...firsts.values(), pick(isCoreMethod), pick(isReference)].filter(Boolean);
}

export const engineOf = (curve) => curve.engine.split(/[:@,]/)[0];
