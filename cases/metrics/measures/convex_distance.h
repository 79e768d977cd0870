// The signed distance of any two convex shapes by their support functions. Shapes that are apart: Gilbert, Johnson and
// Keerthi's algorithm (1988). Shapes that overlap: van den Bergen's expanding polytope (2001), which finds the
// direction of least overlap. Flat shapes take few steps; round ones converge to about 1e-9 of their size. No contact
// method uses it, so that it judges the core's contacts as it judges those of any engine.
#pragma once

#include "core/dynamics/collision/narrow_phase.h"

namespace rigor::inline metric {

struct ConvexGap {
  double gap;   // m, negative where they overlap
  Vec3 normal;  // unit, in W, from b to a
  Vec3 point;   // m, in W, midway between the surfaces
};

// Neither shape is a plane or a compound.
ConvexGap convex_distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

}  // namespace rigor::inline metric
