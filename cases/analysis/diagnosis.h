// Findings in the results, as data. The reports put them into words.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cases/results/results.h"

namespace rigor::inline analysis {

struct Diagnosis {
  std::string topic;              // a row of the table in the analysis that found it
  std::vector<std::size_t> runs;  // indices in Results::runs
  std::string of_case;            // its id
  double value = 0;               // how bad, in the topic's unit
  std::string cause = "";         // the engine's own setting that explains it; empty if it reports none
  std::vector<std::pair<StepSize, double>> over = {};  // the metric at each step, from the coarsest to the finest
  Instant worst = {};                                  // at the step of `value`
  double beside = 0;                                   // the number that `value` is compared with, for some topics
};

}  // namespace rigor::inline analysis
