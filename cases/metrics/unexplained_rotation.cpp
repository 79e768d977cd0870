// The largest angle, over bodies and time, between the engine's and its twin's orientation of a body: the part of the
// orientation error that the scheme does not explain. Relative to one radian.
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_unexplained_rotation(const JudgedRun& run) {
  if (!run.twin) return {{}, kNoTwin};
  const Trajectory& twin = run.twin->trajectory;
  const std::vector<double> one_radian(twin.samples.size(), 1.0);
  const std::size_t count = samples_with_twin(run, run.twin->orientation_rounding, one_radian, kTruthNeededOrientation);
  if (count == 0) return {{}, kNoSamples};
  TimeSeries series;
  for (std::size_t n = 0; n < count; ++n) {
    const BodyColumns found = run.trajectory.samples[n].bodies.columns(), expected = twin.samples[n].bodies.columns();
    Instant worst{.time = twin.samples[n].time, .body = 0, .component = "orientation"};
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double angle = angle_between(found.orientation(i), expected.orientation(i));
      if (angle > worst.found) worst.body = static_cast<int>(i), worst.found = angle;
    }
    series.add(worst.found, worst);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow unexplained_rotation() {
  return {.name = "unexplained_rotation",
          .unit = "rad",
          .summary = "largest angle of a body's orientation from its scheme's own, repeated",
          .measure = measure_unexplained_rotation,
          .needs = {.twin = true}};
}

}  // namespace rigor::inline metric
