// A run's settings in MuJoCo's own words, see engine_calls() in adapters/engines.h.
#pragma once

#include <string>
#include <vector>

#include "adapters/mujoco/mujoco_options.h"
#include "core/engine/engine.h"

namespace rigor::inline adapters {

std::vector<std::string> mujoco_calls(const Settings& settings, const std::string& dt, const MujocoVersion& version);

}  // namespace rigor::inline adapters
