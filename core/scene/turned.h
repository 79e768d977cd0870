// A scene in a world rotated about its origin: the same motion in other coordinates. A difference of the motion comes
// from a scheme that prefers a direction, or from rounding.
#pragma once

#include "core/scene/scene.h"

namespace rigor::inline scene {

// `turn` takes the old world frame's vectors to the new one's.
Scene turned(Scene scene, const Quat& turn);

}  // namespace rigor::inline scene
