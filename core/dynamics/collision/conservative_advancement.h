// Whether two bodies surely stay apart between two states. Let n be a direction that separates them at one end. No
// corner or round end of either can cross to the other within time t, because
//   n·x(t) <= n·x + n·v t + A t²/2,   A the largest acceleration of any of its points on the way,
// and none can leave the bounding radius of the body around its centre. The bound is tightest at both ends of [0, t],
// so only these are checked. It is applied from the first state to the middle, and from the second state back to it. A
// passed check holds at every instant.
#pragma once

#include "core/dynamics/collision/colliders.h"

namespace rigor::inline dynamics {

// A state, and the axis (unit, in W, from b to a) along which the two are furthest apart there.
struct SeparatingAxis {
  BodyColumns state;
  Vec3 n;
};

// How hard a body is accelerated at most on its way.
struct Bend {
  double of_centre = 0, of_points = 0;  // m/s²
};

// m: how far a body reaches along n at most, a time t [s] after the state, or before it if t is negative.
double reach_at_most(const Collider& collider, BodyColumns state, const Vec3& n, const Bend& bend, double t);

// h: s, from the one to the other. missed: m, the deepest overlap that may be overlooked.
bool stay_apart(const Collider& a, const Collider& b, const SeparatingAxis& from, const SeparatingAxis& to,
                const Bend& bend_a, const Bend& bend_b, double h, double missed);

}  // namespace rigor::inline dynamics
