// What keeps more of a run than its numbers: its trajectory as a file, its motion for a page. The runner calls
// recorders in the process that has the run; what one returns travels with the results, and only its own report reads
// it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor {

struct NamedSeries {
  std::string name;            // of the metric
  std::vector<double> values;  // one a sample, may be shorter than the trajectory
};

class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual std::string name() const = 0;
  // Once a case. `facts`: what is known of the truth in numbers.
  virtual Recording of_truth(const Case& definition, const Truth& truth, const TruthFacts& facts) const = 0;
  // Once a cell that was simulated and judged.
  virtual Recording of_run(const Case& definition, const Cell& cell, const JudgedRun& run,
                           const std::vector<NamedSeries>& series, const TruthFacts& facts) const = 0;
  // The cell came to no good end: what may have been kept of it elsewhere goes.
  virtual void discard(const Cell& cell) const = 0;
};
using Recorders = std::vector<std::shared_ptr<const Recorder>>;

}  // namespace rigor
