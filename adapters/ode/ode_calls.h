// The calls that OdeWorld makes for a run's settings.
#pragma once

#include <string>
#include <vector>

#include "core/engine/engine.h"

namespace rigor::inline adapters {

std::vector<std::string> ode_calls(const Settings& settings, const std::string& dt);

}  // namespace rigor::inline adapters
