// What a jointed scene asks of a method beyond the features of its parts (features.h):
// joint_limit_that_bounces, joint_loop, speed_motor_with_limits, two_speeds_at_once. An engine with all parts has these
// features, too, unless a method lists them in MethodInfo::lacks.
#pragma once

#include <vector>

#include "core/scene/features/features.h"

namespace rigor::inline scene {

// Each once, with the first joint that asks for it.
std::vector<Need> joint_traits_of(const Scene& scene);

}  // namespace rigor::inline scene
