// Which step each run needs for each tolerance, and its error beside the median run's: one judgement, which the page
// and other readers only format.
#pragma once

#include "cases/results/results.h"
#include "core/base/json_fwd.h"

namespace rigor::inline report {

Json steps_needed_json(const Results& results, const CaseResult& result);
Json steps_over_cases_json(const Results& results);
Json relative_errors_json(const Results& results);

}  // namespace rigor::inline report
