// The largest distance, over bodies and time, between where a body is and where the truth says it is.
#include <string>

#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

constexpr const char* kAxes[] = {"position.x", "position.y", "position.z"};

// The body furthest off; its coordinate furthest off stands for it.
Instant worst_at(const Sample& sample, BodyColumns truth, double& value) {
  Instant worst{.time = sample.time, .component = kAxes[0]};
  value = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Vec3 found = sample.bodies.columns().position(i), expected = truth.position(i);
    const double distance = (found - expected).norm();
    if (i > 0 && distance <= value) continue;
    int axis = 0;
    (found - expected).cwiseAbs().maxCoeff(&axis);
    value = distance;
    worst = {sample.time, static_cast<int>(i), kAxes[axis], found[axis], expected[axis]};
  }
  return worst;
}

MetricResult measure_position_error(const JudgedRun& run) {
  if (!run.truth) return {{}, kNoTruth};
  const std::size_t count = samples_within(run, kTruthNeededPosition);
  if (count == 0) return {{}, kNoSamples};
  TimeSeries series;
  for (std::size_t n = 0; n < count; ++n) {
    double value = 0;
    const Instant worst = worst_at(run.trajectory.samples[n], run.truth->bodies[n].columns(), value);
    series.add(value, worst);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow position_error() {
  return {.name = "position_error",
          .unit = "m",
          .summary = "largest distance of a body from where the truth has it",
          .measure = measure_position_error,
          .headline = 1};
}

}  // namespace rigor::inline metric
