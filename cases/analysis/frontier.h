// Error against cost over many cases: one curve per run, one point per step size. The report's first picture shows the
// curves; the recommendation is read off them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor::inline analysis {

// What a run did at one step size, over the cases of a scope.
struct FrontierPoint {
  StepSize dt;
  std::size_t cases = 0;   // with an error to compare, or failed
  std::size_t failed = 0;  // of these: no result, or a motion that is wrong as a whole (blown up, collapsed, ...)
  // m, or rad in cases where nothing moves away: over the cases that did not fail. `low` and `high` are the 10th and
  // the 90th percentile over all cases; a failed case counts as infinite.
  double mean = 0;  // geometric
  double low = 0, high = 0;
  double median = 0;  // over all cases, likewise; of an even count the larger of the two in the middle
  double cost = 0;    // s of CPU time per simulated second, geometric mean; 0 where nothing was timed
};

struct Frontier {
  std::size_t run = 0;                // index in Results::runs
  bool is_reference = false;          // an adaptive method of the core: no engine that a user could take instead
  std::size_t unsupported = 0;        // cases of the scope that the run cannot do
  std::vector<FrontierPoint> points;  // coarse to fine; steps that too few cases have are left out
};

// Of the cases whose id begins with `family` and a slash, or of all cases if it is empty. A case counts where it has a
// truth that is independent of the run. Runs without a point are left out. A step is kept if it has at least half as
// many cases as the fullest step of all runs; in a run that has no such step, half as many as its own fullest.
std::vector<Frontier> frontiers(const Results& results, const std::string& family = "");

inline constexpr double kRecommendedTolerance = 1e-3;  // m or rad: what a first answer is for

// The share of failed cases up to which a point may be recommended: one case in twenty.
inline constexpr double kMostFailed = 0.05;

// The largest step whose mean and median errors are within the tolerance, and at which few enough cases fail.
std::optional<StepSize> largest_step_within(const Frontier& frontier, double tolerance);

struct Choice {
  std::size_t run = 0;
  FrontierPoint point;
  std::size_t unsupported = 0;  // as in Frontier
};

// Who may be recommended.
enum class Candidates { engines, core_methods, references };

// The cheapest point whose mean and median errors are within the tolerance, of runs that compare at least half as many
// cases as the run that compares most. The median keeps a few exact cases from hiding the error of most. Where nothing
// was timed, the point with the largest step. None if there is no such point.
std::optional<Choice> cheapest_within(const Results& results, const std::vector<Frontier>& frontiers, double tolerance,
                                      Candidates candidates);

}  // namespace rigor::inline analysis
