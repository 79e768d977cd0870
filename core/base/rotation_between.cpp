#include "core/base/rotation_between.h"

#include <cmath>

namespace rigor {

// With c the cosine of the angle, that of half of it is s / 2, s = sqrt(2 + 2 c) = |a + b|, and its sine times the axis
// (a x b) / s. Near opposite directions 1 + c is but rounding, and |a + b| is not.
Quat rotation_between(const Vec3& from, const Vec3& to) {
  constexpr double kOpposite = 1e-8;  // below, a x b is but rounding
  const Vec3 a = from.normalized(), b = to.normalized();
  const double c = a.dot(b), s = c < 0 ? (a + b).norm() : std::sqrt(2 * (1 + c));
  const Vec3 half = s < kOpposite ? a.unitOrthogonal() : Vec3(a.cross(b) * (1 / s));
  const Quat turn(s < kOpposite ? 0 : s / 2, half.x(), half.y(), half.z());
  return c < 0 ? turn.normalized() : turn;
}

}  // namespace rigor
