// How far a body is above the ground of a surface of triangles, or how deep in it, for trial steps that end beyond the
// first touch. Manifolds leave out overlaps that might be on the other side of a thin wall, and corners below the seam
// of two triangles.
#pragma once

#include "core/dynamics/collision/colliders.h"
#include "core/scene/shapes/surface.h"

namespace rigor::inline dynamics {

// m: no more than the distance, negative for an overlap, infinite far away. It is the least of
//   a corner, or the centre of a ball less its radius, by the signed distance from the surface;
//   an edge that sticks out of the ground, from a polyhedron by its distance from the faces, or from a capsule's axis.
double gap_above_ground(const Collider& body, const Pose& pose, const TriangleSurface& surface, const Pose& of_surface);

}  // namespace rigor::inline dynamics
