#include "core/dynamics/contact/impulse/free_motion.h"

#include <algorithm>

namespace rigor::inline dynamics {

void FreeMotion::advance(double t) { pose = {pose.p + t * v, rotation_by(t * w).toRotationMatrix() * pose.R}; }

FreeMotion FreeMotion::after(double t) const {
  FreeMotion out = *this;
  out.advance(t);
  return out;
}

FreeMotion free_motion_of(BodyColumns state, const Collider& collider, const Pose& pose) {
  if (collider.fixed) return {pose, Vec3::Zero(), Vec3::Zero()};
  return {pose, state.velocity(collider.body), state.angular_velocity(collider.body)};
}

double approach(const ManifoldPoint& point, const FreeMotion& a, const FreeMotion& b) {
  return -point.normal.dot(a.velocity_at(point.point) - b.velocity_at(point.point));
}

double time_of_impact(const Manifold& points, const FreeMotion& a, const FreeMotion& b, double dt) {
  double first = dt;
  for (const ManifoldPoint& point : points) {
    if (point.gap <= 0) return 0;
    const double speed = approach(point, a, b);
    if (point.gap < first * speed) first = point.gap / speed;
  }
  return first < dt ? first : 0;
}

double time_of_turning_impact(const Collider& a, const Collider& b, const FreeMotion& motion_a,
                              const FreeMotion& motion_b, double turning, double margin, double dt) {
  constexpr int kMostLooks = 40;
  Manifold points;
  double t = 0;
  for (int look = 0; look < kMostLooks; ++look) {
    const FreeMotion there_a = motion_a.after(t), there_b = motion_b.after(t);
    collide(a.shape, there_a.pose, b.shape, there_b.pose, points);
    const auto nearest = std::min_element(points.begin(), points.end(),
                                          [](const ManifoldPoint& p, const ManifoldPoint& q) { return p.gap < q.gap; });
    if (nearest == points.end() || nearest->gap <= margin) break;
    const double fastest = turning - nearest->normal.dot(motion_a.v - motion_b.v);
    if (!(fastest > 0) || t + nearest->gap / fastest >= dt) return 0;
    t += nearest->gap / fastest;
  }
  return t;
}

}  // namespace rigor::inline dynamics
