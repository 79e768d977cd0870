// The errors of runs against a recording, as one table: means over the trials with their standard deviations.
#pragma once

#include "cases/report/wording/comparison.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// No rows where the truth is no recording or no run has an error.
TextTable recorded_errors(const Results& results, const CaseResult& result);

}  // namespace rigor::inline report
