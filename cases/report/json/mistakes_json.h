// What `rigor diagnose --json` prints.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cases/analysis/mistakes/finder.h"

namespace rigor {

// `run`: as it was named.
nlohmann::ordered_json mistakes_json(const MistakeReport& report, const std::string& run);

}  // namespace rigor
