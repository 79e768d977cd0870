// Conservative advancement: whether two bodies surely stay apart while they go from one state to another. Along an axis
// n that separates them at one end, no corner or round end of either can have crossed to the other after time t, for
//   n·x(t) <= n·x + n·v t + A t²/2,   A = |a| + (|w|² + |w'|) r,
// a bound that is tightest at both ends of [0, t] and so need only be looked at there. From the first state it is taken
// to the middle, and from the second one back to it. What passes is as if looked at at every instant.
#pragma once

#include "core/dynamics/collision/colliders.h"

namespace rigor {

// A state, and the axis (unit, in W, from b to a) along which the two are furthest apart there.
struct SeparatingAxis {
  BodyColumns state;
  Vec3 n;
};

// h: s, from the one to the other; their accelerations are taken to be at most twice what their velocities tell.
bool stay_apart(const Collider& a, const Collider& b, const SeparatingAxis& from, const SeparatingAxis& to, double h);

}  // namespace rigor
