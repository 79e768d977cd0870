// Jointed bodies as trees, in the order in which bullet:multibody and its twin go through them.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace rigor::bullet {

// A body that hangs on its parent by a joint.
struct Branch {
  int body;
  int parent;  // a body that comes before, or kWorld
  int joint;
};

// A base, and what hangs on it, parents first. On the world, or a fixed body, one joint hangs a tree of its own.
struct Tree {
  int base;  // a body that floats free, or kWorld
  std::vector<Branch> branches;
};

// Every body that moves is in one of them. The joints must close no loop.
std::vector<Tree> trees_of(const Scene& scene);

}  // namespace rigor::bullet
