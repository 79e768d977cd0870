// The rows of a joint: what each says is zero, and its first and second derivative in time,
//   g = 0,   g' = J_a V_a + J_b V_b = 0,   g'' = J_a V_a' + J_b V_b' + bias = 0,
// with V = (v, w) of each end, all in W. Joints are made of four kinds of rows; arms and directions are in W.
#pragma once

#include <Eigen/Core>

#include "core/base/math.h"

namespace rigor {

using Vec6 = Eigen::Matrix<double, 6, 1>;

struct ConstraintRow {
  Vec6 on_a, on_b;  // J_a, J_b: also the wrench (force, torque about the centre of mass) of a unit of the multiplier
  double gap;       // g [m, or a sine or cosine]
  double bias;      // what J' V is
};
inline constexpr int kMostRows = 6;

// How the end of a joint moves: a body, or the world, which stays.
struct EndMotion {
  Vec3 position = Vec3::Zero();  // m
  Mat3 R = Mat3::Identity();     // to W
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();

  Vec3 velocity_at(const Vec3& arm) const { return velocity + angular_velocity.cross(arm); }
  // The acceleration of a point fixed in it that its turning makes.
  Vec3 centripetal(const Vec3& arm) const { return angular_velocity.cross(angular_velocity.cross(arm)); }
};

// Three rows: the points at the two arms coincide.
void keep_together(const EndMotion& a, const Vec3& arm_a, const EndMotion& b, const Vec3& arm_b, ConstraintRow* out);

// A direction t fixed in a and a direction n fixed in b stay at right angles: t · n = 0.
ConstraintRow keep_right_angle(const EndMotion& a, const Vec3& t, const EndMotion& b, const Vec3& n);

// The component of the line d from a's centre to b's along t, which is fixed in a, stays: t · d = offset.
ConstraintRow keep_offset(const EndMotion& a, const Vec3& t, const EndMotion& b, double offset);

// The distance of the points at the two arms stays.
ConstraintRow keep_distance(const EndMotion& a, const Vec3& arm_a, const EndMotion& b, const Vec3& arm_b,
                            double distance);

// Two directions at right angles to `axis` and to each other, so that (first, second, axis) is right-handed.
struct Across {
  Vec3 first, second;
};
Across directions_across(const Vec3& axis);

}  // namespace rigor
