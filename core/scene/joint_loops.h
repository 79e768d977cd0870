// Which joints of a scene lie on a closed loop. Rows of other joints never repeat each other, in whatever position.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline scene {

// By joint: whether its two bodies stay connected without it. World and fixed bodies are one body.
std::vector<bool> joints_on_loops(const Scene& scene);

}  // namespace rigor::inline scene
