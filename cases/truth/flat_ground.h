// Surfaces of triangles that a plane can stand for. A truth that knows planes then holds for bodies over the surface:
// seams between coplanar triangles change no motion.
#pragma once

#include <memory>

#include "cases/truth/truth.h"

namespace rigor::inline truth {

// The scene with a plane in place of each mesh or height field that has a flat region in front of all of its other
// points: the one on which gravity presses most, and without gravity the largest.
Scene on_planes(const Scene& scene);

// The truth of on_planes(scene) as one of the scene itself. Its error is infinite from the instant on at which a body
// comes nearer to the border of such a region than its own size, or behind it. Throws InputError if one starts there.
std::unique_ptr<Truth> truth_over_ground(const Scene& scene, std::unique_ptr<Truth> on_plane, double duration);

}  // namespace rigor::inline truth
