// What `rigor diverge --json` prints and divergence.json holds.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/divergence/divergence.h"
#include "core/base/json_fwd.h"

namespace rigor::inline report {

// `command`: runs the winner of the settings; `calls`: of the engine itself. Both are empty if no setting wins.
Json divergence_json(const Divergence& found, const std::string& command, const std::vector<std::string>& calls);

}  // namespace rigor::inline report
