// Why contacts come out wrong, in words: restitution that does not converge, overlap given back as speed, friction that
// knows directions. What was measured is said with it, and the engine's own setting that explains it.
#pragma once

#include <string>
#include <vector>

#include "cases/runner/results.h"

namespace rigor {

std::vector<std::string> contact_explanations(const Results& results, const CaseResult& result);

}  // namespace rigor
