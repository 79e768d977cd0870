// The order of bodies and the frames of boxes that follow from the scene's geometry alone. Sequential impulses depend
// on the order in which they are applied. With these the motion depends neither on the order of the bodies in the scene
// nor on the handedness of the axes, but where a symmetry of the scene itself leaves a tie.
#pragma once

#include <vector>

#include "core/dynamics/collision/colliders.h"

namespace rigor::inline dynamics {

// Lowest first, then by mass, size and speed; planes last. Bodies that are alike in all of these keep the scene's
// order. So do many bodies: neighbours in memory then matter more, and a pile is chaotic in any order.
std::vector<Collider> in_canonical_order(const Scene& scene, std::vector<Collider> colliders);

// For each collider 1 or -1 by axis of its body. A box is the same box with an axis reversed, but its corners are
// counted in another order: in these frames, which a mirror of the scene mirrors, they are counted alike in a scene and
// its mirror image.
std::vector<Vec3> mirrored_axes(const Scene& scene, const std::vector<Collider>& colliders);

}  // namespace rigor::inline dynamics
