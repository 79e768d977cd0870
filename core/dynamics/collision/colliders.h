// The bodies of a scene that take part in contact, with what their shapes say about size.
#pragma once

#include <vector>

#include "core/dynamics/collision/narrow_phase.h"
#include "core/engine/body_table.h"

namespace rigor::inline dynamics {

// What a shape fills, along W's axes. A plane's is unbounded.
struct Aabb {
  Vec3 low, high;  // m
};

struct Collider {
  int body;
  Shape shape;
  double bounding_radius;  // m, about the body's centre of mass; infinite for a plane
  double inradius;         // m, half the least width: a smaller motion cannot pass through; infinite for a plane
  bool fixed;
};

std::vector<Collider> colliders_of(const Scene& scene);

Pose pose_of(BodyColumns state, int body);
// `margin` is added on all sides.
Aabb aabb_of(const Shape& shape, const Pose& pose, double margin);

}  // namespace rigor::inline dynamics
