// Who loses energy that nothing is meant to take, and why; and whose energy only seems to stray.
#pragma once

#include <optional>

#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/run_names.h"

namespace rigor {

// Of engines that are not ours, at that step. None where there is nothing to say.
std::optional<Finding> energy_finding(const Results& results, const RunNames& names, const StepSize& dt);
std::optional<Finding> sampling_finding(const Results& results, const RunNames& names, const StepSize& dt);

}  // namespace rigor
