// Bounces that do not converge, and overlaps that are pushed out as speed. Each with the case where it is largest, and
// the engine's own setting as the reason.
#pragma once

#include <optional>
#include <vector>

#include "cases/report/wording/findings/findings.h"

namespace rigor::inline report {

// `runs`: the runs to report, in this order.
std::optional<Finding> impacts_finding(const Results& results, const std::vector<std::size_t>& runs);

// Whose contact forces grow as the step shrinks or do not explain the motion, and whose resting bodies creep: of these
// runs, the worst case of each.
std::optional<Finding> contact_forces_finding(const Results& results, const std::vector<std::size_t>& runs);

}  // namespace rigor::inline report
