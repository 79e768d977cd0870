// Whether the final places of an ensemble of starts differ from the reference's.
#pragma once

#include <vector>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// The quantities that these messages state beside metrics: `ensemble starts`, a count.
std::vector<Message> ensemble_explanations(const Results& results, const CaseResult& result);

}  // namespace rigor::inline report
