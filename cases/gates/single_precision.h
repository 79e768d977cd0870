// What an engine that holds its numbers in single precision may be off by its roundings alone: bounds are wider by so
// much for it, for they are set for engines in double precision.
#pragma once

#include <string>

#include "cases/results/results.h"

namespace rigor {

// In the metric's unit, for a run of this step; 0 for a metric that roundings do not reach. `unit`: of the metric.
double single_precision_allowance(const CaseResult& result, double dt, const std::string& unit);

}  // namespace rigor
