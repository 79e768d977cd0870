// Jointed bodies as trees, in the order in which bullet:multibody and its twin go through them.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline adapters::bullet {

// A body that hangs on its parent by a joint.
struct Branch {
  int body;
  int parent;  // a body that comes before, or kWorld
  int joint;
};

// A base and its links, parents first. Each joint to the world, or to a fixed body, starts a tree.
struct Tree {
  int base;  // a body that floats free, or kWorld
  std::vector<Branch> branches;
};

// Every moving body belongs to one of them. The joints must close no loop.
std::vector<Tree> trees_of(const Scene& scene);

}  // namespace rigor::inline adapters::bullet
