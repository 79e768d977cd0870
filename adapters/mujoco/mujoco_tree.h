// Which joints of a scene MuJoCo holds as joints of its trees of bodies, exactly, and which it closes loops with,
// softly.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace rigor {

struct MujocoTree {
  struct Link {
    int parent = kWorld;  // a body that moves, or the world: fixed bodies count as part of it
    int joint = -1;       // Scene::joints, to the parent; -1: the body is free
  };
  std::vector<Link> links;              // by body; of a fixed body without meaning
  std::vector<std::vector<int>> below;  // by body: the bodies that hang on it
  std::vector<int> roots;               // the bodies that hang on the world, or on nothing
  std::vector<int> loops;               // Scene::joints that close a loop, and all distance joints
};

// A spanning forest. Joints that MuJoCo cannot close a loop with (slider, universal) are taken first.
MujocoTree mujoco_tree(const Scene& scene);

}  // namespace rigor
