// The directions along which a curved solid may be separated most from a straight line, or from a point.
#pragma once

#include <array>

#include "core/dynamics/collision/curved/curved_solid.h"

namespace rigor::inline dynamics {

// Unit vectors, from the line or point to the solid.
class Ways {
 public:
  void add(const Vec3& n) { ways_[static_cast<std::size_t>(count_++)] = n; }
  const Vec3* begin() const { return ways_.data(); }
  const Vec3* end() const { return ways_.data() + count_; }

 private:
  std::array<Vec3, 6> ways_;
  int count_ = 0;
};

// `along`: unit. All ways are across it.
Ways ways_from_line(const CurvedSolid& solid, const Vec3& on_line, const Vec3& along);
Ways ways_from_point(const CurvedSolid& solid, const Vec3& p);

// For the point of an ellipsoid that is nearest to p: the root t > -min(r²) of sum (r_i p_i / (r_i² + t))² = 1, of the
// squares r_i² and the products r_i p_i. The nearest point is r_i² p_i / (r_i² + t).
double nearest_root(const Vec3& squares, const Vec3& products);

// The direction out of an ellipsoid about the origin, at the point of its surface that is nearest to p.
Vec3 out_of_ellipsoid(const Vec3& radii, const Vec3& p);

}  // namespace rigor::inline dynamics
