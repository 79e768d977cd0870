// The trials of a cell whose truth is a recording with several. A cell carries them among its recordings, which every
// message and journal keeps. Its metrics are the means over them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor::inline results {

struct TrialResult {
  std::string name;
  Status status = Status::crashed;
  std::string reason;                     // empty for `pass`
  std::map<std::string, double> metrics;  // those with a value
};

// A metric over the trials that have a value.
struct TrialSpread {
  std::size_t count = 0;
  double mean = 0, standard_deviation = 0, median = 0;  // the deviation is 0 for a single one
  std::string worst;                                    // the name of the worst trial
  double worst_value = 0;
};

void keep_trials(Cell& cell, const std::vector<TrialResult>& trials);
std::vector<TrialResult> trials_of(const Cell& cell);  // none for a cell without trials

// The name under which a recorder's result for the k-th trial travels: for the first, the recorder's own.
std::string recording_of_trial(const std::string& recorder, std::size_t trial);

// None where no trial has a value.
std::optional<TrialSpread> spread_over(const std::vector<TrialResult>& trials, const std::string& metric);

// The difference of a metric between two cells, taken trial by trial. What is hard for both drops out.
struct PairedDifference {
  double mean = 0, low = 0, high = 0;  // low to high: the 95 % interval of the mean, by Student's distribution
  bool is_certain() const { return low > 0 || high < 0; }
};
// None with fewer than two trials that have a value in both.
std::optional<PairedDifference> paired_difference(const std::vector<TrialResult>& of,
                                                  const std::vector<TrialResult>& than, const std::string& metric);

}  // namespace rigor::inline results
