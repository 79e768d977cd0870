// Sentences that say why a case's runs came out as they did, as far as the scene, the methods' stated facts and the
// measured values show it.
#pragma once

#include <vector>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

std::vector<Message> explanations(const Results& results, const CaseResult& result);

}  // namespace rigor::inline report
