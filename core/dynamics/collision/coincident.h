// Bodies with coincident centres have no direction in which to separate. One is treated as a millionth of their size
// aside. Each body has its own direction, so that many bodies in one place separate to all sides.
#pragma once

#include <algorithm>

#include "core/dynamics/collision/colliders.h"

namespace rigor::inline dynamics {

// Evenly spread over [-1/2, 1/2]³ (Roberts, The unreasonable effectiveness of quasirandom sequences, 2018).
inline Vec3 direction_of_its_own(const Collider& collider) {
  const double n = collider.body + 1;
  const Vec3 x = n * Vec3(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  return x - x.array().floor().matrix() - Vec3::Constant(0.5);
}

// How far `a` at p_a is taken to lie aside from `b` at p_b, m; mostly zero.
inline Vec3 aside_of(const Collider& a, const Vec3& p_a, const Collider& b, const Vec3& p_b) {
  constexpr double kCoincident = 1e-9, kAside = 1e-6;  // of the smaller inradius
  const double size = std::min(a.inradius, b.inradius);
  if (!((p_a - p_b).squaredNorm() < kCoincident * kCoincident * size * size)) return Vec3::Zero();
  return kAside * size * (direction_of_its_own(a) - direction_of_its_own(b));
}

}  // namespace rigor::inline dynamics
