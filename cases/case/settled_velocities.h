// The nearest initial velocities that the joints of a scene allow.
#pragma once

#include "core/scene/scene.h"

namespace rigor::inline cases {

// Changes only bodies with joints, and nothing if no joint is broken. The nearest velocities differ least in the metric
// of the masses. Poses are always allowed, because anchors and axes are given at t = 0. Throws InputError if the joints
// allow no velocities.
void settle_velocities(Scene& scene);

}  // namespace rigor::inline cases
