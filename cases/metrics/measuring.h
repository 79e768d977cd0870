// What metrics share: keeping the worst of a course of values, and how far a truth can be compared with.
#pragma once

#include <cstddef>

#include "cases/metrics/metric.h"

namespace rigor {

// Collects a metric's value at one sample after another; the worst instant is that of the largest.
class Course {
 public:
  void add(double value, const Instant& instant);
  Measurement finish() &&;

 private:
  Measurement measurement_;
};

// The truth must be this good at an instant to be compared with there. At the steps that are judged a scheme is off by
// a micrometre or more within a few steps; below that, an angle or a length says nothing about the scheme.
inline constexpr double kTruthNeededPosition = 1e-6;     // m
inline constexpr double kTruthNeededOrientation = 1e-6;  // rad

// The first samples of the run, all those at which the truth's own error stays within `needed`. No truth: none.
std::size_t samples_within(const JudgedRun& run, double needed);

inline constexpr const char* kNoTruth = "the case has no truth";
inline constexpr const char* kNoSamples = "there is no sample at which the truth is good enough";

}  // namespace rigor
