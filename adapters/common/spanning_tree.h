// Which joints of a scene an engine in reduced coordinates holds as joints of its trees of bodies, exactly, and which
// it closes loops with, by constraints.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace rigor {

struct SpanningTree {
  struct Link {
    int parent = kWorld;  // a body that moves, or the world: fixed bodies count as part of it
    int joint = -1;       // Scene::joints, to the parent; -1: the body is free
  };
  std::vector<Link> links;              // by body; of a fixed body without meaning
  std::vector<std::vector<int>> below;  // by body: the bodies that hang on it
  std::vector<int> roots;               // the bodies that hang on the world, or on nothing
  std::vector<int> loops;               // Scene::joints that close a loop, and all distance joints
};

// A spanning forest. Joints that engines cannot close a loop with (slider, cylindrical, universal) are taken first.
SpanningTree spanning_tree(const Scene& scene);

// At t = 0, the speeds of the joint that hangs `body` on its parent, of the body against the parent: along or about the
// axis of a slider or hinge [m/s, rad/s]; along, then about a cylindrical joint's axis; about the parent's, then the
// body's own axis of a universal joint; a ball's turning in the body's frame; none of a fixed joint.
std::vector<double> hanging_speeds(const Scene& scene, const SpanningTree& tree, int body);

}  // namespace rigor
