// The mean distance from recorded positions, in percent of a length that the case gives (A. Acosta, W. Yang, M. Posa,
// Validating Robotics Simulators on Real-World Impacts, 2022: percent of the cube's width).
#include "cases/metrics/measures/recorded/recorded_gaps.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_mean_position_error(const JudgedRun& run) {
  if (const std::string why = why_no_recording(run); !why.empty()) return {{}, why};
  const double length = as_recording(run.truth->source)->recording().length;
  if (!(length > 0)) return {{}, "the case gives no truth.length, of which the error would be a share"};
  return mean_gap(run, RecordedPart::position, 100 / length);
}

}  // namespace

MetricRow mean_position_error() {
  return {.name = "mean_position_error",
          .unit = "%",
          .summary = "mean distance from recorded positions, in percent of truth.length; at least what noise makes",
          .measure = measure_mean_position_error};
}

}  // namespace rigor::inline metric
