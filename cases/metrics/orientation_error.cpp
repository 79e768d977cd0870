// The largest angle, over bodies and time, of the turn that takes a body's orientation to the truth's. A quaternion and
// its negative are the same orientation, and a quaternion's length does not matter here (see orthonormality_error).
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_orientation_error(const JudgedRun& run) {
  if (!run.truth) return {{}, kNoTruth};
  const std::size_t count = samples_within(run, kTruthNeededOrientation);
  if (count == 0) return {{}, kNoSamples};
  TimeSeries series;
  for (std::size_t n = 0; n < count; ++n) {
    const Sample& sample = run.trajectory.samples[n];
    const BodyColumns found = sample.bodies.columns(), truth = run.truth->bodies[n].columns();
    Instant worst{.time = sample.time, .body = 0, .component = "orientation"};
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double angle = angle_between(found.orientation(i), truth.orientation(i));
      if (angle > worst.found) worst.body = static_cast<int>(i), worst.found = angle;
    }
    series.add(worst.found, worst);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow orientation_error() {
  return {.name = "orientation_error",
          .unit = "rad",
          .summary = "largest angle of a body's orientation from the truth's",
          .measure = measure_orientation_error,
          .headline = 2};
}

}  // namespace rigor::inline metric
