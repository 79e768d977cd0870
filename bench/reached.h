// How right a run is, to stand beside its speed.
#pragma once

#include "bench/scenes.h"
#include "core/engine/engine.h"

namespace rigor::bench {

// "error_m_rad", "energy_error", "penetration_m", "joint_gap_m".
const char* reached_name(Reached what);

// Over one second (two for a pile), of at most 1000 bodies; not a number where that cannot be said.
double reached(const SceneRow& row, int count, const Engine& engine, const Settings& settings);

}  // namespace rigor::bench
