// Comparisons of a case's cells for results.json: observed_order, spread and work_precision.
#pragma once

#include "cases/results/results.h"
#include "core/base/json_fwd.h"

namespace rigor::inline report {

Json observed_orders_json(const Results& results, const CaseResult& result);
Json spreads_json(const Results& results, const CaseResult& result);
Json own_steps_json(const Results& results, const CaseResult& result);
Json work_precision_json(const Results& results, const CaseResult& result);

}  // namespace rigor::inline report
