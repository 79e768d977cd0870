// Changes between the baselines of two runs, beyond noise.
#pragma once

#include <string>
#include <vector>

#include "cases/results/baseline.h"

namespace rigor::inline results {

// An error this small [m, rad, 1] is rounding, and its growth says nothing.
inline constexpr double kNoise = 1e-9;
// Errors repeat to the last bit on one machine; another compiler rounds otherwise, and a chaotic run shows it.
inline constexpr double kDefaultFactor = 1.25;

struct Changes {
  // A sentence each, sorted.
  std::vector<std::string> newly_failing, newly_passing;
  std::vector<std::string> worse, better;    // metrics, by more than the factor
  std::vector<std::string> lost;             // metrics that are measured no longer, though nobody asked for that
  std::vector<std::string> settings;         // that differ
  std::vector<std::string> shorter, longer;  // cases by their durations: their metrics are not compared
  std::vector<std::string> added, gone;      // cases, and runs or steps of a case
  bool is_worse() const {
    return !newly_failing.empty() || !worse.empty() || !lost.empty() || !gone.empty() || !shorter.empty();
  }
};

Changes changes_between(const Baseline& old_baseline, const Baseline& new_baseline, double factor = kDefaultFactor);

std::string text_of(const Changes& changes, double factor);

}  // namespace rigor::inline results
