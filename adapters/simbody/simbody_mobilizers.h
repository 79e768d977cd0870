// The mobilizer of Simbody that connects each body of a scene with its parent, for the adapter and for its twins.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline adapters {

enum class MobilizerKind { free, ball, cylinder, pin, slider, universal, weld };

// Its two frames, F in the parent and M in the body, coincide at t = 0, where they have these axes and this origin. A
// pin turns about their z, a cylinder turns about z and moves along it, a slider moves along x, a universal joint turns
// about F's x, then about M's y.
struct Mobilizer {
  MobilizerKind kind;
  int body;
  int parent;   // a body that comes before, or kWorld
  Mat3 axes;    // in W
  Vec3 origin;  // m, in W
};

// Parents first; without the fixed bodies, which are part of the world.
std::vector<Mobilizer> mobilizers_of(const Scene& scene);

// Unit vectors at right angles, of which the column `which` has this direction.
Mat3 axes_with(int which, const Vec3& direction);

}  // namespace rigor::inline adapters
