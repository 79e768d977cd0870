// What `rigor diagnose --json` prints.
#pragma once

#include <string>

#include "cases/analysis/mistakes/finder.h"
#include "core/base/json_fwd.h"

namespace rigor::inline report {

// `run`: as it was named.
Json mistakes_json(const MistakeReport& report, const std::string& run);

}  // namespace rigor::inline report
