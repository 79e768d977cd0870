// The rotation of a body without torque, in the splitting that conserves its angular momentum L: in principal axes with
// moments a (the median), b, c,
//   H = |L|²/(2a) + (1/b - 1/a)/2 L_b² + (1/c - 1/a)/2 L_c².
// Each part turns the body exactly: the first about L in space by dt |L|/a, the others about their own axis. The first
// commutes with the others, and these are composed symmetrically: second order, |L| kept to rounding, and exact where
// two moments are equal. (Splittings of the free rigid body: Hairer, Lubich, Wanner, Geometric Numerical Integration,
// VII.5.)
#pragma once

#include "core/dynamics/system.h"

namespace rigor {

class FreeRotation {
 public:
  explicit FreeRotation(const Inertia& body);
  // The orientation after dt with constant angular momentum L in W.
  Quat advance(const Quat& q_WB, const Vec3& L, double dt) const;

 private:
  Quat q_BP_ = Quat::Identity();             // principal axes to B
  double inverse_median_ = 0;                // 1/(kg m²)
  double excess_low_ = 0, excess_high_ = 0;  // 1/b - 1/a of the smallest (P's x) and the largest moment (P's z)
};

// One for each body of the system.
std::vector<FreeRotation> free_rotations(const System& system);

}  // namespace rigor
