// The errors against a recording, in columns.
#pragma once

#include <string>

#include "cases/results/results.h"

namespace rigor::inline report {

// Empty where the truth is no recording.
std::string recorded_table(const Results& results, const CaseResult& result);

}  // namespace rigor::inline report
