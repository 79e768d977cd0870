// A scene for whoever has MuJoCo: MJCF with the scene's own names, its limits and motors, and its velocities as a
// keyframe. What the adapter itself steps is mujoco_mjcf.h's.
#pragma once

#include <string>

#include "core/scene/link_model.h"

namespace rigor {

std::string mjcf_for_others(const Scene& scene, LeftOut& left_out);

}  // namespace rigor
