// Bodies of a mechanism that has one angle x, since t = 0, and an inertia about it that does not change: each goes
//   p = p0 + (cos x - 1) A + sin x B
// and turns with the angle about an axis, or keeps its own spin. Then
//   M x'' = -P sin x + Q cos x,   M = sum m |B|² + n . I n,  P = sum m g . A,  Q = sum m g . B,
// the equation of a pendulum, if  sum m |A|² = sum m |B|²  and  sum m A . B = 0  (its inertia is the same at each x).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cases/truth/closed_form/joint/pendulum_phase.h"

namespace rigor::inline truth {

struct Swing {
  int body = kWorld;                           // index
  ExtendedVec3 along = ExtendedVec3::Zero();   // m, A, in W
  ExtendedVec3 across = ExtendedVec3::Zero();  // m, B, in W
  bool turns = false;                          // with x, about the axis
};

// What a swing of a point `arm` [m] from an axis through it is.
Swing round_axis(int body, const ExtendedVec3& axis, const ExtendedVec3& arm, bool turns);

using Refuse = std::function<void(const std::string& why)>;  // throws

// The truth in which these bodies, all that move, follow the angle about the unit `axis`. Refuses a body whose velocity
// does not follow from the angle's rate, or whose inertia changes. With `spins` it may have any rotation where it does
// not rotate with x. `rotor`: an inertia [kg m²] on the angle that is no body's.
std::unique_ptr<Truth> swinging(const Scene& scene, const ExtendedVec3& axis, const std::vector<Swing>& swings,
                                bool spins, const Refuse& refuse, Extended rotor = 0);

// Where a joint's end that does not move has a point given in its frame; m, in W.
ExtendedVec3 standing_point(const Scene& scene, int body, const Vec3& point);
bool stands(const Scene& scene, int body);

}  // namespace rigor::inline truth
