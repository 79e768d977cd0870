// Raw velocities and angular velocities, compared with those of the engine's twin for as long as its positions and
// orientations are comparable. A rounding of a position gives one of a velocity, times the motion's fastest frequency.
#include <algorithm>

#include "cases/metrics/measures/rate_gap.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_unexplained_velocity(const JudgedRun& run, RateOf rate, const char* letter) {
  if (!run.twin) return {{}, kNoTwin};
  const Trajectory& twin = run.twin->trajectory;
  const std::vector<double> one_radian(twin.samples.size(), 1.0);
  const std::size_t count =
      std::min(samples_with_twin(run, run.twin->position_rounding, motion_extents(twin), kTruthNeededPosition),
               samples_with_twin(run, run.twin->orientation_rounding, one_radian, kTruthNeededOrientation));
  return rate_gap(run, count, rate, letter, [&](std::size_t n) { return twin.samples[n].bodies.columns(); });
}

}  // namespace

MetricRow unexplained_spin() {
  return {
      .name = "unexplained_spin",
      .unit = "rad/s",
      .summary = "largest difference of a body's angular velocity from its scheme's own, repeated",
      .measure =
          [](const JudgedRun& run) { return measure_unexplained_velocity(run, &BodyColumns::angular_velocity, "w"); },
      .needs = {.twin = true}};
}

MetricRow unexplained_velocity() {
  return {
      .name = "unexplained_velocity",
      .unit = "m/s",
      .summary = "largest difference of a body's velocity from its scheme's own, repeated",
      .measure = [](const JudgedRun& run) { return measure_unexplained_velocity(run, &BodyColumns::velocity, "v"); },
      .needs = {.twin = true}};
}

}  // namespace rigor::inline metric
