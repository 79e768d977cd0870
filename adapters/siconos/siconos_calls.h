// A run's settings as the calls of Siconos that make them.
#pragma once

#include <string>
#include <vector>

#include "core/engine/engine.h"

namespace rigor::inline adapters {

std::vector<std::string> siconos_calls(const Settings& settings, const std::string& dt);

}  // namespace rigor::inline adapters
