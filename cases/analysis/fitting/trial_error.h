// How far one run is from its truth, in the units of a fit.
#pragma once

#include <limits>

#include "cases/case/case.h"
#include "cases/truth/truth.h"
#include "core/engine/engine.h"

namespace rigor::inline analysis {

struct TrialError {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  // The mean square of the gaps in standard deviations of the noise: 1 if noise alone makes them. It is the mean of
  // that of positions and that of orientations. None if the run did not reach the end.
  double square = kNone;
  double position = kNone;  // m, the mean gap; none if positions were not measured
  double rotation = kNone;  // rad, likewise
  bool has_result() const { return square == square; }
};

// The case starts as its trial does. A computed truth is that of the case as written. It counts as known to 1e-6 m and
// rad, as far as it is that good.
TrialError trial_error(const Case& of_trial, const Truth& truth, const Engine& engine, const Settings& settings,
                       double dt);

}  // namespace rigor::inline analysis
