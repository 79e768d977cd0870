// What is said of joints that come apart, stretch or take energy: what was measured, and the engine's own setting that
// explains it.
#pragma once

#include "cases/analysis/joint_diagnosis.h"

namespace rigor {

std::vector<std::string> joint_explanations(const Results& results, const CaseResult& result);

}  // namespace rigor
