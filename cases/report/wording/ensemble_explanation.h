// What is said of a case with ensembles: which runs let bodies end where the reference does, and which do not.
#pragma once

#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor {

std::vector<std::string> ensemble_explanations(const Results& results, const CaseResult& result);

}  // namespace rigor
