// Fits scene values and engine options to the truth of one or several cases. A Latin hypercube finds where to start,
// and the simplex method of Nelder and Mead goes on from there. Trials that no value explains count little (Huber's
// loss, smoothed). Intervals come from a bootstrap over the trials. Fewer than five recorded trials have the profile
// likelihood instead, and their values are the most likely ones.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/sweep/sweep_axis.h"
#include "cases/case/vocabulary.h"
#include "cases/results/results.h"

namespace rigor::inline analysis {

struct FitInput {
  std::vector<Case> cases;  // each with one step
  RunName run;
  std::vector<SweepAxis> axes;  // ranges
  double hold_out = 0;          // share of the trials that take no part
  unsigned long seed = 1;
  int jobs = 1;
  double limit = 60;                                       // s of CPU time for each run
  std::function<void(std::size_t points)> on_points = {};  // called with the number of points tried so far
};

struct FittedParameter {
  std::string key, unit;
  std::string value;  // as it goes into the case file
  double number = 0;
  std::optional<std::pair<double, double>> interval;  // 95 %
  // This end of the interval is that of the range, and the data tell no end on this side.
  bool is_low_open = false, is_high_open = false;
  bool is_at_bound = false;  // the best value is an end of the range: the true one may lie beyond
  std::string unknown;       // why the data cannot tell the value; empty if they can
};

// Of the fitted values, over some of the trials.
struct FitErrors {
  std::size_t trials = 0, without_result = 0;
  double position = 0, position_spread = 0;  // mean and standard deviation of mean gaps; in % with a length, else m
  double rotation = 0, rotation_spread = 0;  // degrees
  bool is_percent = false;
};

struct FitResult {
  std::vector<FittedParameter> parameters;
  std::vector<std::vector<double>> correlations;  // of the parameters; empty without intervals
  FitErrors training;
  std::optional<FitErrors> held_out;
  std::string method;                // of the intervals: "bootstrap", "profile"; empty without them
  std::string why_no_intervals;      // a sentence; empty if there are intervals
  std::vector<std::string> caveats;  // sentences on what the intervals rest on
  std::size_t points = 0;            // tried
};

// The trials fewer than which a bootstrap tells no interval: two halves of them are no sample.
inline constexpr std::size_t kFewestTrials = 5;

// Throws InputError for an unknown key, with a near match, and for values that the cases cannot have.
FitResult fit(const FitInput& input, const EngineTable& engines, const Vocabulary& vocabulary);

}  // namespace rigor::inline analysis
