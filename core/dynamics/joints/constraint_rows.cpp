#include "core/dynamics/joints/constraint_rows.h"

namespace rigor {
namespace {

Vec6 joined(const Vec3& linear, const Vec3& angular) {
  Vec6 both;
  both << linear, angular;
  return both;
}

}  // namespace

void keep_together(const EndMotion& a, const Vec3& arm_a, const EndMotion& b, const Vec3& arm_b, ConstraintRow* out) {
  const Vec3 gap = (b.position - a.position) + (arm_b - arm_a), bias = b.centripetal(arm_b) - a.centripetal(arm_a);
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = Vec3::Unit(k);
    out[k] = {joined(-e, -arm_a.cross(e)), joined(e, arm_b.cross(e)), gap[k], bias[k]};
  }
}

ConstraintRow keep_right_angle(const EndMotion& a, const Vec3& t, const EndMotion& b, const Vec3& n) {
  const Vec3 turn = n.cross(t);
  const double bias = a.centripetal(t).dot(n) + t.dot(b.centripetal(n)) +
                      2 * a.angular_velocity.cross(t).dot(b.angular_velocity.cross(n));
  return {joined(Vec3::Zero(), -turn), joined(Vec3::Zero(), turn), t.dot(n), bias};
}

ConstraintRow keep_offset(const EndMotion& a, const Vec3& t, const EndMotion& b, double offset) {
  const Vec3 d = b.position - a.position;
  const double bias = 2 * a.angular_velocity.cross(t).dot(b.velocity - a.velocity) + a.centripetal(t).dot(d);
  return {joined(-t, t.cross(d)), joined(t, Vec3::Zero()), t.dot(d) - offset, bias};
}

ConstraintRow keep_distance(const EndMotion& a, const Vec3& arm_a, const EndMotion& b, const Vec3& arm_b,
                            double distance) {
  const Vec3 d = (b.position - a.position) + (arm_b - arm_a);
  const double length = d.norm();
  const Vec3 n = d / length, rate = b.velocity_at(arm_b) - a.velocity_at(arm_a);
  const double bias =
      n.dot(b.centripetal(arm_b) - a.centripetal(arm_a)) + (rate - n.dot(rate) * n).squaredNorm() / length;
  return {joined(-n, -arm_a.cross(n)), joined(n, arm_b.cross(n)), length - distance, bias};
}

Across directions_across(const Vec3& axis) {
  const Vec3 first = axis.unitOrthogonal();
  return {first, axis.cross(first)};
}

}  // namespace rigor
