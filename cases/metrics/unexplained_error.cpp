// The largest distance, over bodies and time, between the engine's and its twin's position of a body: the part of the
// position error that the scheme does not explain. In metres; it is rounding while below 1e-9 of motion_extents().
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_unexplained_error(const JudgedRun& run) {
  if (!run.twin) return {{}, kNoTwin};
  const Trajectory& twin = run.twin->trajectory;
  const std::size_t count =
      samples_with_twin(run, run.twin->position_rounding, motion_extents(twin), kTruthNeededPosition);
  if (count == 0) return {{}, kNoSamples};
  TimeSeries series;
  for (std::size_t n = 0; n < count; ++n) {
    const BodyColumns found = run.trajectory.samples[n].bodies.columns(), expected = twin.samples[n].bodies.columns();
    double value = 0;
    Instant worst{.time = twin.samples[n].time, .body = 0, .component = "position.x"};
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Vec3 apart = found.position(i) - expected.position(i);
      if (i > 0 && apart.norm() <= value) continue;
      int axis = 0;
      apart.cwiseAbs().maxCoeff(&axis);
      value = apart.norm();
      worst.body = static_cast<int>(i), worst.component = std::string("position.") + "xyz"[axis];
      worst.found = found.position(i)[axis], worst.expected = expected.position(i)[axis];
    }
    series.add(value, worst);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow unexplained_error() {
  return {.name = "unexplained_error",
          .unit = "m",
          .summary = "largest distance of a body from where the engine's own scheme, repeated, has it",
          .measure = measure_unexplained_error,
          .needs = {.twin = true}};
}

}  // namespace rigor::inline metric
