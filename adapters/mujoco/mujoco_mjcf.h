// A scene in MJCF, MuJoCo's own XML. Bodies are called b0, b1, … by their index, their shapes g0, g1, …, joints j0 (and
// j0x, j0y of a universal joint), springs s0, distance joints d0.
//
// MuJoCo's conventions and ours: SI here and there; quaternions (w, x, y, z), body to world; a body's frame is that of
// its parent's child, and we set its origin at the centre of mass as ours; a capsule by its half length along z, a box
// by half edges, a plane by a frame whose z is the normal.
#pragma once

#include <string>

#include "adapters/spanning_tree.h"
#include "core/engine/engine.h"

namespace rigor {

// Bodies that hang on each other: TinyXML-2, which reads for MuJoCo, nests a hundred elements.
inline constexpr int kDeepestBody = 95;

std::string mujoco_mjcf(const Scene& scene, const SpanningTree& tree, const Settings& settings);

}  // namespace rigor
