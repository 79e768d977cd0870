// The features that a scene needs of an engine. They are compared with those that an engine declares before a scene is
// loaded. A scene that an engine cannot express ends as `unsupported`, with the reason, and is never approximated
// silently.
#pragma once

#include <string>
#include <vector>

#include "core/scene/features/feature.h"

namespace rigor::inline scene {

struct Need {
  Feature feature;
  std::string because;  // what in the scene asks for it, e.g. "bodies 'ball' and 'ground' may touch"
};

// Each feature once, with the first thing that asks for it. Contact features come from the pairs of colliding bodies
// of which at least one can move.
std::vector<Need> needs_of(const Scene& scene);
bool needs(const Scene& scene, Feature feature);
Feature feature_of(const Motor& motor);

}  // namespace rigor::inline scene
