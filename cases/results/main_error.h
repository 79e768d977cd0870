#pragma once

#include <string>

#include "cases/results/results.h"

namespace rigor::inline results {

// The metric that a case is about: the position error; the orientation error where nothing moves away; the drift of the
// energy where there is no truth.
std::string main_error(const CaseResult& result);

}  // namespace rigor::inline results
