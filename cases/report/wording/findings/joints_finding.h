// Whose joints hold and whose stretch, over all jointed cases.
#pragma once

#include <optional>
#include <vector>

#include "cases/report/wording/findings/findings.h"

namespace rigor {

// Of these runs, in this order, at that step. None where no case has joints.
std::optional<Finding> joints_finding(const Results& results, const std::vector<std::size_t>& runs, const StepSize& dt);

}  // namespace rigor
