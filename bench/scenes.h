// The scenes that are timed, for any number of bodies. Every body moves in them for as long as a benchmark lasts.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::bench {

struct SceneRow {
  std::string name;
  Scene (*make)(int bodies);
};

const std::vector<SceneRow>& scenes();  // one row a scene

}  // namespace rigor::bench
