// Rotation vectors phi [rad]: a turn by |phi| about phi's direction, made by rotation_by (math.h).
#pragma once

#include "core/base/math.h"

namespace rigor {

// Of a unit quaternion; at most half a turn, and of half a turn one of the two.
inline Vec3 rotation_vector_of(const Quat& q) {
  const double sine = q.vec().norm(), angle = 2 * portable::atan2(sine, std::abs(q.w()));
  const double scale = sine < 1e-8 ? 2 : angle / sine;
  return (q.w() < 0 ? -scale : scale) * q.vec();
}

// Returns J, which converts the rate of phi to the angular velocity in W. rotation_by(phi + d) = rotation_by(J d)
// rotation_by(phi) up to squares of d (Solà, Deray and Atchuthan, A micro Lie theory, 2018, eq. 145). Exact to a few
// roundings.
inline Mat3 left_jacobian(const Vec3& phi) {
  const double theta = phi.norm(), squared = theta * theta;
  const Mat3 cross = cross_matrix(phi);
  // (1 - cos)/theta² and (theta - sin)/theta³, from their series where the quotients would lose digits.
  const double half_sine = theta < 1e-4 ? 0.5 - squared / 48 : portable::sin(0.5 * theta) / theta;
  const double rest = theta < 1e-2 ? 1.0 / 6 - squared / 120 + squared * squared / 5040
                                   : (theta - portable::sin(theta)) / (squared * theta);
  return Mat3::Identity() + 2 * half_sine * half_sine * cross + rest * cross * cross;
}

// phi's rate [rad/s] where the body turns at w [rad/s, in W]: J^-1 w, for less than a whole turn (eq. 146 there).
inline Vec3 rate_of_rotation_vector(const Vec3& phi, const Vec3& w) {
  const double theta = phi.norm();
  const Vec3 turn = phi.cross(w);
  const double c = theta < 1e-3
                       ? 1.0 / 12 + theta * theta / 720
                       : (1 - 0.5 * theta * portable::cos(0.5 * theta) / portable::sin(0.5 * theta)) / (theta * theta);
  return w - 0.5 * turn + c * phi.cross(turn);
}

}  // namespace rigor
