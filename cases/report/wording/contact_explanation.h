// What is said of contacts that come out wrong: what was measured, and the engine's own setting that explains it.
#pragma once

#include "cases/analysis/contact_diagnosis.h"

namespace rigor {

std::vector<std::string> contact_explanations(const Results& results, const CaseResult& result);

// "0.3 at 1/30, 0.1 at 1/60".
std::string text_over_steps(const Diagnosis& found);

}  // namespace rigor
