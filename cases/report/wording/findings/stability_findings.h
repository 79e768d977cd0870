// Runs that blow up, and runs that hold stiff springs, at the headline step.
#pragma once

#include <optional>

#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/run_names.h"

namespace rigor::inline report {

// The quantities that these findings state, of a run at the step over all cases:
//   cells that blew up, cells that ran           counts
//   stiff cells that blew up, stiff cells        likewise, of cases whose springs have frequency dt >= 1
//   stiff cells that are not stable              neither stable nor blown up
// Both are empty where there is nothing to say.
std::optional<Finding> blow_up_finding(const Results& results, const RunNames& names, const StepSize& dt);
std::optional<Finding> stiff_springs_finding(const Results& results, const RunNames& names, const StepSize& dt);

}  // namespace rigor::inline report
