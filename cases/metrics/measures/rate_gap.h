// The largest difference, over bodies and time, of velocities or angular velocities between a run and a comparison.
#pragma once

#include <functional>
#include <string>

#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {

using RateOf = Vec3 (BodyColumns::*)(std::size_t body) const;

// Over the first `count` samples; expected(n) is the comparison for the n-th.
inline MetricResult rate_gap(const JudgedRun& run, std::size_t count, RateOf rate, const std::string& letter,
                             const std::function<BodyColumns(std::size_t n)>& expected) {
  if (count == 0) return {{}, kNoSamples};
  TimeSeries series;
  for (std::size_t n = 0; n < count; ++n) {
    const Sample& sample = run.trajectory.samples[n];
    const BodyColumns found = sample.bodies.columns(), other = expected(n);
    double value = -1;
    Instant worst{.time = sample.time, .body = 0, .component = letter + ".x"};
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Vec3 mine = (found.*rate)(i), its = (other.*rate)(i), apart = mine - its;
      if (apart.norm() <= value) continue;
      int axis = 0;
      apart.cwiseAbs().maxCoeff(&axis);
      value = apart.norm();
      worst.body = static_cast<int>(i), worst.component = letter + "." + "xyz"[axis];
      worst.found = mine[axis], worst.expected = its[axis];
    }
    series.add(value, worst);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace rigor::inline metric
