// External engines that lose or gain energy which they should keep, and why. Engines whose energy only seems to drift.
#pragma once

#include <optional>

#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/run_names.h"

namespace rigor::inline report {

// The quantities that these findings state, of the case in which a run's value is the largest:
//   worst energy loss, worst energy gain   a share, signed
//   scheme's share of energy_drift         scheme's energy_drift / signed energy_drift
//   duration                               s, of the case
//   worst sampling                         energy_drift, where velocities are read half a step from positions
// Of external engines, at that step. Empty where there is nothing to say.
std::optional<Finding> energy_finding(const Results& results, const RunNames& names, const StepSize& dt);
std::optional<Finding> sampling_finding(const Results& results, const RunNames& names, const StepSize& dt);

}  // namespace rigor::inline report
