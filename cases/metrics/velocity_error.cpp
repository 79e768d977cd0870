// Raw velocities and angular velocities, compared with the truth's. A semi-implicit step leaves them half a step behind
// the positions. This is a first-order error here, because the values read belong to no single instant.
#include "cases/metrics/measures/rate_gap.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_velocity_error(const JudgedRun& run, RateOf rate, const char* letter) {
  if (!run.truth) return {{}, kNoTruth};
  return rate_gap(run, samples_within(run, kTruthNeededPosition), rate, letter,
                  [&](std::size_t n) { return run.truth->bodies[n].columns(); });
}

}  // namespace

MetricRow angular_velocity_error() {
  return {"angular_velocity_error", "rad/s", "largest difference of a body's angular velocity from the truth's",
          [](const JudgedRun& run) { return measure_velocity_error(run, &BodyColumns::angular_velocity, "w"); }};
}

MetricRow velocity_error() {
  return {"velocity_error", "m/s", "largest difference of a body's velocity from the truth's",
          [](const JudgedRun& run) { return measure_velocity_error(run, &BodyColumns::velocity, "v"); }};
}

}  // namespace rigor::inline metric
