// Everything that the reports show, as one JSON value; cases/report/json/results.schema.json describes it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cases/results/results.h"

namespace rigor {

nlohmann::ordered_json results_json(const Results& results);

}  // namespace rigor
