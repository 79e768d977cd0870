// How far an orientation is from a rotation: the largest Frobenius norm of RᵀR - I, over bodies and time. R is the
// engine's own matrix where it keeps one, else that of its quaternion as it stands, whose lost norm then shows.
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_orthonormality_error(const JudgedRun& run) {
  if (run.trajectory.samples.empty()) return {{}, "the run has no finite sample"};
  TimeSeries series;
  for (const Sample& sample : run.trajectory.samples) {
    Instant worst{.time = sample.time, .body = 0, .component = "RᵀR - I"};
    for (std::size_t i = 0; i < sample.bodies.size(); ++i) {
      const Mat3 R = sample.bodies.columns().rotation(i);
      const double error = (R.transpose() * R - Mat3::Identity()).norm();
      if (error > worst.found) worst.body = static_cast<int>(i), worst.found = error;
    }
    series.add(worst.found, worst);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow orthonormality_error() {
  return {.name = "orthonormality_error",
          .unit = "1",
          .summary = "largest Frobenius norm of RᵀR - I of a body's orientation as the engine holds it",
          .measure = measure_orthonormality_error,
          .needs = {}};
}

}  // namespace rigor::inline metric
