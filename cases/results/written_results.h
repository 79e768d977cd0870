// Results that stand in a results.json, read back as far as errors are compared: the runs, the cases and their truths'
// errors, and of each cell its status, verdict, metrics and settings. Scenes, gates and recordings are not read.
#pragma once

#include "cases/results/results.h"
#include "core/base/json_fwd.h"

namespace rigor::inline results {

// Throws std::exception for JSON that is no results.json of the present schema.
Results results_from(const Json& results);

}  // namespace rigor::inline results
