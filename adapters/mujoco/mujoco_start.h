// What a model of MuJoCo is when it starts: without what its file switches off, and in which state.
#pragma once

#include <string>
#include <vector>

#include "adapters/mujoco/mujoco_library.h"

namespace rigor {

// What a file's <flag> switches off by name, and a scene can say: the model is one that does not have it.
inline constexpr int kSwitchesTaken = mjDSBL_CONSTRAINT | mjDSBL_EQUALITY | mjDSBL_FRICTIONLOSS | mjDSBL_LIMIT |
                                      mjDSBL_CONTACT | mjDSBL_PASSIVE | mjDSBL_GRAVITY | mjDSBL_ACTUATION;
void take_switches(mjModel& model);

// A keyframe without a name goes by its number, from 0.
std::vector<std::string> keyframes_of(const mjModel& model);

// The bodies where a keyframe has them, or, without one, the model's own state, and their velocities. Throws InputError
// for a name that no keyframe has, with a near match.
mujoco_library::Data mujoco_start(const mjModel& model, const std::string& path, const std::string& keyframe);

// How far apart the ends of a connection or a weld are at a state [m; a weld's turn in rad]; of other equalities 0.
double opening_of(const mjModel& model, const mjData& state, int equality);

}  // namespace rigor
