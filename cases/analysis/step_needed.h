// The largest step size that keeps an error within a tolerance: per case, and over all cases of a run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor::inline analysis {

// The tolerances [m or rad] that reports offer.
inline constexpr double kTolerances[] = {1e-4, 1e-3, 1e-2, 1e-1};

// tried: a step that was run. between: on the line, in logarithms, between two steps that were run. beyond: below the
// finest step, on the line through the last two. none: no step keeps the tolerance; `seconds` is then 0.
struct StepNeeded {
  enum class Found { none, beyond, between, tried } found = Found::none;
  double seconds = 0;
  bool is_coarsest = false;  // the case's coarsest step keeps the tolerance: a longer one may do so too

  bool operator<(const StepNeeded& other) const { return seconds < other.seconds; }
};
std::string word_of(StepNeeded::Found found);

// Every finer step that was run must keep the tolerance too. A cell that blew up, crashed, timed out or is invalid does
// not keep it. `beyond` is read only where the error falls with order 0.5 at least, and to a 30th of the finest step at
// most. Nothing for a run that has no such error in this case, or that is held to a truth of its own.
std::optional<StepNeeded> step_needed(const CaseResult& result, std::size_t run, const std::string& metric,
                                      double tolerance);

// One run over the cases that have an error against a truth.
struct StepOverCases {
  std::size_t run = 0;
  bool is_reference = false;  // see is_reference_method
  std::size_t cases = 0;      // in which the run has such an error
  std::size_t failed = 0;     // of these, cases in which no step keeps the tolerance
  StepNeeded median;          // of an even count the worse of the two in the middle
};

// In the order of the runs. A run that has an error in fewer than half of these cases is left out.
std::vector<StepOverCases> steps_over_cases(const Results& results, double tolerance);

}  // namespace rigor::inline analysis
