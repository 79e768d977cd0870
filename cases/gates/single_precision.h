// The error from rounding alone of an engine in single precision. Bounds are set for double precision, so they are
// wider by this amount.
#pragma once

#include <string>

#include "cases/results/results.h"

namespace rigor::inline gates {

// In the metric's unit, for a run of this step; 0 for a metric that roundings do not reach. `unit`: of the metric.
double single_precision_allowance(const CaseResult& result, double dt, const std::string& unit);

}  // namespace rigor::inline gates
