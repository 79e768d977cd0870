// Whether two bodies surely stay apart while they go from one state to another: along a direction n that parts them at
// one end, no corner or round end of either can have crossed to the other after time t, for
//   n·x(t) <= n·x + n·v t + A t²/2,   A the largest acceleration of any of its points on the way,
// nor to beyond the bounding radius of the body round its centre, a bound that is tightest at both ends of [0, t] and
// so need only be looked at there. From the first state it is taken to the middle, and from the second one back to it.
// What passes is as if looked at at every instant.
#pragma once

#include "core/dynamics/collision/colliders.h"

namespace rigor {

// A state, and the axis (unit, in W, from b to a) along which the two are furthest apart there.
struct SeparatingAxis {
  BodyColumns state;
  Vec3 n;
};

// How hard a body is accelerated at most on its way.
struct Bend {
  double of_centre = 0, of_points = 0;  // m/s²
};

// h: s, from the one to the other. missed: m, the deepest overlap that may be overlooked.
bool stay_apart(const Collider& a, const Collider& b, const SeparatingAxis& from, const SeparatingAxis& to,
                const Bend& bend_a, const Bend& bend_b, double h, double missed);

}  // namespace rigor
