// The rotation of a body without torque, in the splitting that conserves its angular momentum L: in principal axes with
// moments a (the median), b, c,
//   H = |L|²/(2a) + (1/b - 1/a)/2 L_b² + (1/c - 1/a)/2 L_c².
// Each part rotates the body exactly: the first about L in space by dt |L|/a, the others about their own axes. The
// first commutes with the others, and these are composed symmetrically. The result has second order, keeps |L| to
// rounding, and is exact if two moments are equal. (Splittings of the free rigid body: Hairer, Lubich, Wanner,
// Geometric Numerical Integration, VII.5.) The kernel free_drift takes this step; this file prepares its data of a
// body.
#pragma once

#include "core/dynamics/model/system.h"

namespace rigor::inline dynamics {

struct FreeRotation {
  explicit FreeRotation(const Inertia& body);

  Quat q_BP = Quat::Identity();            // principal axes to B
  double inverse_median = 0;               // 1/(kg m²)
  double excess_low = 0, excess_high = 0;  // 1/b - 1/a of the smallest (P's x) and the largest moment (P's z)
};

}  // namespace rigor::inline dynamics
