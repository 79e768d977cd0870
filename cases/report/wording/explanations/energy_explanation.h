// Why energy drifts, or seems to, at a case's coarsest step; and why first-order methods miss a fall.
#pragma once

#include <vector>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// The quantities that these messages state beside metrics:
//   missed fall   m, g/2 dt t after 1 s
std::vector<Message> energy_explanations(const Results& results, const CaseResult& result);

}  // namespace rigor::inline report
