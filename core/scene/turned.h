// A scene in a world turned about its origin: the same motion, seen from elsewhere. What moves otherwise in it is
// either a scheme that prefers a direction or rounding.
#pragma once

#include "core/scene/scene.h"

namespace rigor {

// `turn` takes the old world frame's vectors to the new one's.
Scene turned(Scene scene, const Quat& turn);

}  // namespace rigor
