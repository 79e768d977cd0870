// How far a run is from a recording, at the run's own samples.
#pragma once

#include <string>
#include <vector>

#include "cases/metrics/metric.h"
#include "cases/truth/recorded/recorded_motion.h"

namespace rigor::inline metric {

enum class RecordedPart { position, orientation };

struct RecordedGap {
  double time = 0;  // s
  int body = 0;
  double gap = 0;  // m, or rad
};

// The gaps of every body at every sample of the run, as far as this part was measured there. The first sample is left
// out, because the run begins where the recording does.
std::vector<RecordedGap> recorded_gaps(const Trajectory& trajectory, const RecordedMotion& truth, RecordedPart part);

// Whether the run reached the end of the trial or of the case, up to one sample.
bool reaches_the_end(const Trajectory& trajectory, const RecordedMotion& truth, double duration);

// A metric in the unit of which one m or rad is `scale`: the mean gap, but never less than noise alone makes.
MetricResult mean_gap(const JudgedRun& run, RecordedPart part, double scale);

// "the truth is no recording"; empty if it is one.
std::string why_no_recording(const JudgedRun& run);

}  // namespace rigor::inline metric
