// Compares errors at equal CPU time. The cells of a run are points of a curve of log error against log cost. The curve
// is read at the cost of another run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/results/observed_order.h"

namespace rigor::inline analysis {

// interpolated: the cost lies between two of the run's own cells.
// extrapolated: the cost is below the cheapest cell. The line through the first two cells is used up to a step four
// times as long, and no longer than the largest stable step. at_most: the cost is above the dearest cell. Its error is
// a bound, because the run could use smaller steps.
enum class Reach { interpolated, extrapolated, at_most };
std::string word_of(Reach reach);

struct AtCost {
  double error = 0;
  Reach reach = Reach::interpolated;
};
// `points` in any order. No value if the curve does not reach the cost.
std::optional<AtCost> error_at_cost(std::vector<ErrorPoint> points, double cost, double largest_stable_dt);

// A run compared with one cell of a baseline.
struct EqualCost {
  std::size_t run = 0, baseline = 0;  // indices in Results::runs
  ErrorPoint of_baseline;
  std::optional<AtCost> of_run;
  double times_less() const { return of_run ? of_baseline.error / of_run->error : 0; }
};

// Engines other than the in-house core, on the track `matched`.
std::vector<std::size_t> baselines(const Results& results);

// `run` beside each cell of `baseline` that has a result.
std::vector<EqualCost> at_equal_cost(const CaseResult& result, std::size_t run, std::size_t baseline,
                                     const std::string& metric);

// The core's method with the largest geometric mean gain, among those comparable with the most cells of a baseline.
// Adaptive reference methods do not compete. One point a cell of the baseline, in their order.
struct BestOfCore {
  std::string metric;
  std::vector<EqualCost> points;
  std::size_t compared() const;  // points that have a value of the run's
  double mean() const;           // of times_less, geometric, over those
  double least() const;
};
std::optional<BestOfCore> best_of_core(const Results& results, const CaseResult& result, std::size_t baseline,
                                       const std::string& metric);

}  // namespace rigor::inline analysis
