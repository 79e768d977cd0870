// Cylinders and ellipsoids with each other, and with boxes, capsules and hulls; normals from the second to the first.
// Shapes further apart than `far` [m] get no points.
#pragma once

#include "core/dynamics/collision/curved/curved_solid.h"
#include "core/dynamics/collision/narrow_phase.h"

namespace rigor::inline dynamics {

void collide_curved(const CurvedSolid& a, const Box& b, const Pose& pose_b, Manifold& out, double far);
void collide_curved(const CurvedSolid& a, const Convex& b, const Pose& pose_b, Manifold& out, double far);
void collide_curved(const Capsule& a, const Pose& pose_a, const CurvedSolid& b, Manifold& out);
void collide_curved(const CurvedSolid& a, const CurvedSolid& b, Manifold& out, double far);

// On a surface: the points with a gap of at most the solid's size.
void collide_curved(const CurvedSolid& a, const TriangleSurface& b, const Pose& pose_b, Manifold& out);

}  // namespace rigor::inline dynamics
