// What the cells of a case say of each other, for results.json: observed_order, spread and work_precision.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cases/results/results.h"

namespace rigor {

nlohmann::ordered_json observed_orders_json(const Results& results, const CaseResult& result);
nlohmann::ordered_json spreads_json(const Results& results, const CaseResult& result);
nlohmann::ordered_json work_precision_json(const Results& results, const CaseResult& result);

}  // namespace rigor
