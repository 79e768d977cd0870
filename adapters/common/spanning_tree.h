// Divides the joints of a scene for an engine in reduced coordinates: exact joints of its trees of bodies, and
// constraints that close loops.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline adapters {

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

// The two directions along which a planar joint is written as sliders.
struct PlaneDirections {
  Vec3 first, second;
  explicit PlaneDirections(const Vec3& normal) : first(normal.unitOrthogonal()), second(normal.cross(first)) {}
};

// A spanning forest. Joints that engines cannot close a loop with (slider, compound, cylindrical, planar, screw,
// universal) are taken first. The axes of compound joints are no joints of their own.
SpanningTree spanning_tree(const Scene& scene);

// The speeds at t = 0 of the joint between `body` and its parent, relative to the parent. Slider or hinge: along or
// about the axis [m/s, rad/s]. Cylindrical joint and screw: along, then about the axis. Planar joint: along
// both PlaneDirections, then about the normal. Compound joint: of each axis, from the parent outwards. Universal joint:
// about the parent's axis, then the body's. Ball: the angular velocity in the body's frame. Fixed joint: none.
std::vector<double> hanging_speeds(const Scene& scene, const SpanningTree& tree, int body);

}  // namespace rigor::inline adapters
