// The rows of a joint: the value that must be zero, and its first and second derivative in time,
//   g = 0,   g' = J_a V_a + J_b V_b = 0,   g'' = J_a V_a' + J_b V_b' + bias = 0,
// with V = (v, w) of each end, all in W. Joints are made of four kinds of rows; arms and directions are in W.
#pragma once

#include <Eigen/Core>

#include "core/base/math.h"

namespace rigor::inline dynamics {

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

inline Vec6 joined(const Vec3& linear, const Vec3& angular) {
  Vec6 both;
  both << linear, angular;
  return both;
}

// Each row has two forms: the whole row, and its gap alone, which needs only poses. They stand in the header because a
// step evaluates them most often.

// Three rows: the points at the two arms coincide.
inline void keep_together(const EndMotion& a, const Vec3& arm_a, const EndMotion& b, const Vec3& arm_b, double* gaps) {
  for (int k = 0; k < 3; ++k) gaps[k] = (b.position[k] - a.position[k]) + (arm_b[k] - arm_a[k]);
}
inline void keep_together(const EndMotion& a, const Vec3& arm_a, const EndMotion& b, const Vec3& arm_b,
                          ConstraintRow* out) {
  const Vec3 bias = b.centripetal(arm_b) - a.centripetal(arm_a);
  double gaps[3];
  keep_together(a, arm_a, b, arm_b, gaps);
  out[0].on_a << -1, 0, 0, 0, -arm_a.z(), arm_a.y();
  out[1].on_a << 0, -1, 0, arm_a.z(), 0, -arm_a.x();
  out[2].on_a << 0, 0, -1, -arm_a.y(), arm_a.x(), 0;
  out[0].on_b << 1, 0, 0, 0, arm_b.z(), -arm_b.y();
  out[1].on_b << 0, 1, 0, -arm_b.z(), 0, arm_b.x();
  out[2].on_b << 0, 0, 1, arm_b.y(), -arm_b.x(), 0;
  for (int k = 0; k < 3; ++k) out[k].gap = gaps[k], out[k].bias = bias[k];
}

// A direction t fixed in a and a direction n fixed in b stay at right angles: t · n = 0.
inline void keep_right_angle(const EndMotion&, const Vec3& t, const EndMotion&, const Vec3& n, double* gap) {
  *gap = t.dot(n);
}
inline void keep_right_angle(const EndMotion& a, const Vec3& t, const EndMotion& b, const Vec3& n, ConstraintRow* out) {
  const Vec3 turn = n.cross(t);
  const double bias = a.centripetal(t).dot(n) + t.dot(b.centripetal(n)) +
                      2 * a.angular_velocity.cross(t).dot(b.angular_velocity.cross(n));
  *out = {joined(Vec3::Zero(), -turn), joined(Vec3::Zero(), turn), t.dot(n), bias};
}

// The component of the line d from a's centre to a point of b along t, which is fixed in a, stays: t · d = offset.
inline void keep_offset(const EndMotion& a, const Vec3& t, const EndMotion& b, const Vec3& arm_b, double offset,
                        double* gap) {
  *gap = t.dot((b.position - a.position) + arm_b) - offset;
}
inline void keep_offset(const EndMotion& a, const Vec3& t, const EndMotion& b, const Vec3& arm_b, double offset,
                        ConstraintRow* out) {
  const Vec3 d = (b.position - a.position) + arm_b;
  const double bias = 2 * a.angular_velocity.cross(t).dot(b.velocity_at(arm_b) - a.velocity) + a.centripetal(t).dot(d) +
                      t.dot(b.centripetal(arm_b));
  *out = {joined(-t, t.cross(d)), joined(t, arm_b.cross(t)), t.dot(d) - offset, bias};
}

// The distance of the points at the two arms stays.
inline void keep_distance(const EndMotion& a, const Vec3& arm_a, const EndMotion& b, const Vec3& arm_b, double distance,
                          double* gap) {
  *gap = ((b.position - a.position) + (arm_b - arm_a)).norm() - distance;
}
inline void keep_distance(const EndMotion& a, const Vec3& arm_a, const EndMotion& b, const Vec3& arm_b, double distance,
                          ConstraintRow* out) {
  const Vec3 d = (b.position - a.position) + (arm_b - arm_a);
  const double length = d.norm();
  const Vec3 n = d / length, rate = b.velocity_at(arm_b) - a.velocity_at(arm_a);
  const double bias =
      n.dot(b.centripetal(arm_b) - a.centripetal(arm_a)) + (rate - n.dot(rate) * n).squaredNorm() / length;
  *out = {joined(-n, -arm_a.cross(n)), joined(n, arm_b.cross(n)), length - distance, bias};
}

// Two directions at right angles to `axis` and to each other, so that (first, second, axis) is right-handed.
struct Across {
  Vec3 first, second;
};
inline Across directions_across(const Vec3& axis) {
  const Vec3 first = axis.unitOrthogonal();
  return {first, axis.cross(first)};
}

}  // namespace rigor::inline dynamics
