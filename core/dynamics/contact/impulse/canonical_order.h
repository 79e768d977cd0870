// Orders of bodies and of contact points that follow from the scene's geometry alone. Sequential impulses depend on the
// order in which they are applied. With these orders the motion depends neither on the order of the bodies in the scene
// nor on the handedness of the axes, but where a symmetry of the scene itself leaves a tie.
#pragma once

#include <vector>

#include "core/dynamics/collision/colliders.h"

namespace rigor {

// Lowest first, then by mass, size and distance from the middle. Many bodies keep the scene's order: neighbours in
// memory then matter more, and a pile is chaotic in any order.
std::vector<Collider> in_canonical_order(const Scene& scene, std::vector<Collider> colliders);

// For each collider a direction in its body's frame: no two corners of a box lie equally far along it, and it is
// mirrored as the scene is.
std::vector<Vec3> ordering_directions(const Scene& scene, const std::vector<Collider>& colliders);

// Sorts by the distance along a direction.
void sort_along(const Vec3& direction_W, Manifold& points);

}  // namespace rigor
