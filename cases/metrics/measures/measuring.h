// Shared code of metrics: the worst of a series of values, and how long a truth can be compared.
#pragma once

#include <cstddef>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {

// Collects a metric's value at one sample after another; the worst instant is that of the largest.
class TimeSeries {
 public:
  void add(double value, const Instant& instant);
  Measurement finish() &&;

 private:
  Measurement measurement_;
};

// The required accuracy of the truth at a compared instant. At the judged steps a scheme has an error of a micrometre
// or more after a few steps. Below that, an angle or a length says nothing about the scheme.
inline constexpr double kTruthNeededPosition = 1e-6;     // m
inline constexpr double kTruthNeededOrientation = 1e-6;  // rad

// The first samples of the run, all those at which the truth's own error stays within `needed`. No truth: none. Nor are
// there any where only the start would be: there nothing is off.
std::size_t samples_within(const JudgedRun& run, double needed);

// A run is compared with its twin while the truth, if any, is accurate enough, and while rounding alone cannot have
// separated them by more than this share of their scale. Rounding grows with the sensitivity of the motion. Past that
// instant no distance between the two says anything about the engine.
inline constexpr double kRoundingShare = 1e-10;

// m: the farthest from W's origin that a body of the twin has come by each sample. Positions are rounded relative to
// it.
std::vector<double> motion_extents(const Trajectory& trajectory);

// The number of first samples at which the run can be compared with its twin, if more than the start. `rounding` is the
// twin's, `scale` its scale at each sample.
std::size_t samples_with_twin(const JudgedRun& run, const std::vector<double>& rounding,
                              const std::vector<double>& scale, double needed_of_truth);

inline constexpr const char* kNoTwin =
    "the run has no twin: it is a core scheme, bodies can touch, or the twin lacks its joints";
inline constexpr const char* kNoTruth = "the case has no truth";
inline constexpr const char* kNoSamples = "there is no sample after the start at which the truth is good enough";

}  // namespace rigor::inline metric
