// What `rigor fit --json` prints of one engine, in SI units.
#pragma once

#include "cases/analysis/fitting/fitting.h"
#include "core/base/json_fwd.h"

namespace rigor::inline report {

Json fit_json(const FitInput& input, const FitResult& fit);

}  // namespace rigor::inline report
