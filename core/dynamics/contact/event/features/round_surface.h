// A curved surface that touches at a single point: an ellipsoid, or the rim of a cylinder, which is an ellipsoid
// without thickness. With the half-axes as the columns of A, the point with the outward normal m is
//   s(m) = A Aᵀ m/|Aᵀ m|,
// and if the normal turns by dm, the point moves over the surface by S dm, with
//   S = (A Aᵀ - s sᵀ)/|Aᵀ m|,
// the inverse of the surface's curvature: the principal radii of curvature are its eigenvalues across m.
#pragma once

#include "core/base/math.h"

namespace rigor::inline dynamics {

struct RoundPoint {
  Vec3 at;        // m, from the centre
  Mat3 by_turns;  // m: S
};
// `half_axes`: A [m]. A rim has no normal along its axis.
RoundPoint point_with_normal(const Mat3& half_axes, const Vec3& normal);

// The point nearest to p, which is outside, from the centre; of a rim, to any p off its axis.
Vec3 nearest_point(const Mat3& half_axes, const Vec3& p);

// The third half-axis of a rim is zero.
inline bool is_rim(const Mat3& half_axes) { return half_axes.col(2).isZero(0); }

}  // namespace rigor::inline dynamics
