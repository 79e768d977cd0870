// The state that a model of MuJoCo starts from.
#pragma once

#include <string>
#include <vector>

#include "adapters/mujoco/mujoco_library.h"

namespace rigor {

// A keyframe without a name goes by its number, from 0.
std::vector<std::string> keyframes_of(const mjModel& model);

// The bodies where a keyframe has them, or, without one, the model's own state, and their velocities. Throws InputError
// for a name that no keyframe has, with a near match.
mujoco_library::Data mujoco_start(const mjModel& model, const std::string& path, const std::string& keyframe);

// How far apart the ends of a connection or a weld are at a state [m; a weld's turn in rad]; of other equalities 0.
double opening_of(const mjModel& model, const mjData& state, int equality);

}  // namespace rigor
