// Keeps more of a run than its numbers: its trajectory as a file, its motion for a page. The runner calls recorders in
// the process of the run. A recorder's result travels with the results, and only its own report reads it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor::inline runner {

struct NamedSeries {
  std::string name;            // of the metric
  std::vector<double> values;  // one a sample, may be shorter than the trajectory
};

class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual std::string name() const = 0;
  // Called once per case. `facts`: numbers about the truth.
  virtual Recording of_truth(const Case& definition, const Truth& truth, const TruthFacts& facts) const = 0;
  // Once a cell that was simulated and judged.
  virtual Recording of_run(const Case& definition, const Cell& cell, const JudgedRun& run,
                           const std::vector<NamedSeries>& series, const TruthFacts& facts) const = 0;
  // Of a recording with trials: whether it keeps each trial, or else the first one alone.
  virtual bool keeps_each_trial() const { return false; }
  // Removes files that were kept for a cell: before it runs, and if it fails.
  virtual void discard(const Cell& cell) const = 0;
  // Whether the files of a cell still exist, for a run that continues from another's journal.
  virtual bool still_has(const Cell& cell) const = 0;
};
using Recorders = std::vector<std::shared_ptr<const Recorder>>;

}  // namespace rigor::inline runner
