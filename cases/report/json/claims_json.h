// The facts that a message states, for programs.
#pragma once

#include <vector>

#include "cases/report/wording/message.h"
#include "core/base/json_fwd.h"

namespace rigor::inline report {

Json claims_json(const std::vector<Claim>& claims);

}  // namespace rigor::inline report
