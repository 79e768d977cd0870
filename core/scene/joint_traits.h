// What a jointed scene asks of a method beyond the features of its parts (features.h):
//   "joint-limit-that-bounces" a limit with a restitution
//   "joint-loop"              joints that close a loop, through bodies or through the world
//   "speed-motor-with-limits" a joint that has limits and a motor that keeps a speed
//   "two-speeds-at-once"      a joint with two motors that keep speeds in the same time
// An engine with all parts has these features, too, unless a method lists them in MethodInfo::lacks.
#pragma once

#include <vector>

#include "core/scene/features.h"

namespace rigor {

// Each once, with the first joint that asks for it.
std::vector<Need> joint_traits_of(const Scene& scene);

}  // namespace rigor
