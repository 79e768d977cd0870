// Bounces that do not converge, and overlaps that are pushed out as speed. Each with the case where it is largest, and
// the engine's own setting as the reason.
#pragma once

#include <optional>
#include <vector>

#include "cases/report/wording/findings/findings.h"

namespace rigor {

// `runs`: the runs to report, in this order.
std::optional<Finding> impacts_finding(const Results& results, const std::vector<std::size_t>& runs);

}  // namespace rigor
