// What is known of contacts and was measured here, for those who come to look for it: bounces that do not converge, and
// overlaps that are pushed out as speed. Each with the case where it is largest, and the engine's own setting as the
// reason.
#pragma once

#include <optional>
#include <vector>

#include "cases/report/wording/findings/findings.h"

namespace rigor {

// Of these runs, in this order.
std::optional<Finding> impacts_finding(const Results& results, const std::vector<std::size_t>& runs);

}  // namespace rigor
