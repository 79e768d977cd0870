// Sentences that say why a case's runs came out as they did, as far as its scene, the methods' stated facts and the
// measured values show it.
#pragma once

#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor {

std::vector<std::string> explanations(const Results& results, const CaseResult& result);

}  // namespace rigor
