// The truth at the instants of a run's samples. All runs of a case at one step share these instants. The truth is
// evaluated there once, before the cells' processes are forked, which inherit the values.
#pragma once

#include <map>

#include "cases/metrics/metric.h"

namespace rigor::inline runner {

class TruthOnSteps {
 public:
  // Keeps the truth at n dt, 0 <= n dt <= duration; nothing where that would take more than a share of the memory.
  void keep(const Truth& truth, double dt, double duration, std::size_t bodies);
  // Evaluates at every sample of the trajectory. Stored values are used as long as the instants are equal to the last
  // bit.
  TruthSamples at_samples_of(const Trajectory& trajectory, const Truth& truth, std::size_t bodies,
                             double largest_kinetic_energy) const;

 private:
  struct Kept {
    std::vector<double> times;  // s
    std::vector<KeptBodies> bodies;
    std::vector<double> error;
  };
  std::map<double, Kept> by_dt_;
};

}  // namespace rigor::inline runner
