// What `rigor diverge --json` prints.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/divergence/divergence.h"
#include "core/base/json_fwd.h"

namespace rigor {

Json divergence_json(const Divergence& found, const std::vector<std::string>& calls);

}  // namespace rigor
