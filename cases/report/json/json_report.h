// Everything that the reports show, as one JSON value; cases/report/json/results.schema.json describes it.
#pragma once

#include "cases/results/results.h"
#include "core/base/json_fwd.h"

namespace rigor::inline report {

Json results_json(const Results& results);

}  // namespace rigor::inline report
