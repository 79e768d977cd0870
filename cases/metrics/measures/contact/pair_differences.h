// Compares what an engine reports of each pair of bodies with what the truth's motion implies.
#pragma once

#include <functional>
#include <optional>

#include "cases/metrics/measures/contact/equilibrium.h"

namespace rigor::inline metric {

// One pair, in the step that ends with sample `n`.
struct PairAtStep {
  std::size_t n;
  BodyPair pair;
  const PairWrench& found;
  const DueWrench& due;
};

struct PairDifference {
  double size;  // in the metric's unit
  double found, expected;
};
using DifferenceOfPair = std::function<std::optional<PairDifference>(const PairAtStep&)>;

// The largest difference among the pairs at each step. `difference` gives none for a pair that it cannot compare.
// Pairs whose wrench is not determined in full, by the projector `counts`, are named with the worst instant; where all
// are like that, there is no result. `what` names the quantity: "force", "moment".
MetricResult largest_pair_difference(const JudgedRun& run, const std::string& what, Mat3 DueWrench::*counts,
                                     const DifferenceOfPair& difference);

// Why there is nothing to compare; empty if there is.
std::string why_no_pairs(const JudgedRun& run);

}  // namespace rigor::inline metric
