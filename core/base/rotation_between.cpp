#include "core/base/rotation_between.h"

namespace rigor {

// With s = |from + to|, the cosine of half the angle is s / 2 and the sine of it times the axis (from x to) / s.
Quat rotation_between(const Vec3& from, const Vec3& to) {
  constexpr double kOpposite = 1e-8;  // below, from x to is but rounding
  const double s = (from + to).norm();
  const Vec3 half = s < kOpposite ? from.unitOrthogonal() : Vec3(from.cross(to) / s);
  return Quat(s < kOpposite ? 0 : s / 2, half.x(), half.y(), half.z()).normalized();
}

}  // namespace rigor
