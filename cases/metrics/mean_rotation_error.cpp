// The mean angle from recorded orientations, in degrees (A. Acosta, W. Yang, M. Posa, Validating Robotics Simulators on
// Real-World Impacts, 2022).
#include "cases/metrics/measures/recorded/recorded_gaps.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_mean_rotation_error(const JudgedRun& run) {
  if (const std::string why = why_no_recording(run); !why.empty()) return {{}, why};
  constexpr double kDegrees = 57.29577951308232;  // in one radian
  return mean_gap(run, RecordedPart::orientation, kDegrees);
}

}  // namespace

MetricRow mean_rotation_error() {
  return {.name = "mean_rotation_error",
          .unit = "deg",
          .summary = "mean angle from recorded orientations; at least what noise makes",
          .measure = measure_mean_rotation_error};
}

}  // namespace rigor::inline metric
