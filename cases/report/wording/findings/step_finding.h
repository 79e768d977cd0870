// The step size that a millimetre takes, over all cases.
#pragma once

#include <optional>

#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/run_names.h"

namespace rigor::inline report {

// The quantity that this finding states: `median step for a tolerance` [s] of a run; 0: no step keeps it.
// `part`: the tolerance [m or rad]. Empty where no run has an error in enough cases.
std::optional<Finding> step_finding(const Results& results, const RunNames& names);

}  // namespace rigor::inline report
