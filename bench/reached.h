// How right a run is, to stand beside its speed.
#pragma once

#include <utility>
#include <vector>

#include "bench/scenes.h"
#include "core/engine/engine.h"

namespace rigor::bench {

// "error_m_rad", "energy_error", "penetration_m", "joint_gap_m" and their values, over one second (two with contacts),
// of at most 1300 bodies. What cannot be said is not a number.
using Figures = std::vector<std::pair<const char*, double>>;
Figures reached(const SceneRow& row, int count, const Engine& engine, const Settings& settings);

}  // namespace rigor::bench
