#include "core/dynamics/contact/event/features/round_surface.h"

#include "core/dynamics/collision/curved/curved_ways.h"

namespace rigor::inline dynamics {

RoundPoint point_with_normal(const Mat3& half_axes, const Vec3& normal) {
  const Vec3 stretched = half_axes.transpose() * normal;
  const double length = stretched.norm();
  const Vec3 at = half_axes * stretched / length;
  return {at, (half_axes * half_axes.transpose() - at * at.transpose()) / length};
}

// x = A Aᵀ (A Aᵀ + t)⁻¹ p. In the frame of the half-axes this is r_i² p_i/(r_i² + t).
Vec3 nearest_point(const Mat3& half_axes, const Vec3& p) {
  const Vec3 along = half_axes.transpose() * p;
  if (is_rim(half_axes)) return half_axes * along.normalized();
  const Vec3 squares = half_axes.colwise().squaredNorm();
  return half_axes * along.cwiseQuotient((squares.array() + nearest_root(squares, along)).matrix());
}

}  // namespace rigor::inline dynamics
