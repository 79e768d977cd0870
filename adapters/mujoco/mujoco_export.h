// A scene for users of MuJoCo: MJCF with the scene's own names, its limits and motors, and its velocities as a
// keyframe. The adapter itself steps the text of mujoco_mjcf.h.
#pragma once

#include <string>

#include "core/scene/link_model.h"

namespace rigor::inline adapters {

std::string mjcf_for_others(const Scene& scene, LeftOut& left_out);

}  // namespace rigor::inline adapters
