// A run's settings in Simbody's own words, see engine_calls() in adapters/engines.h.
#pragma once

#include <string>
#include <vector>

#include "core/engine/engine.h"

namespace rigor::inline adapters {

std::vector<std::string> simbody_calls(const Settings& settings, const std::string& dt);

}  // namespace rigor::inline adapters
