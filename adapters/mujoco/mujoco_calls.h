// A run's settings in MuJoCo's own words, see engine_calls() in adapters/engines.h.
#pragma once

#include <string>
#include <vector>

#include "core/engine/engine.h"

namespace rigor {

// `tolerance`: of the solver, on the track `matched`.
std::vector<std::string> mujoco_calls(const Settings& settings, const std::string& dt, double tolerance);

}  // namespace rigor
