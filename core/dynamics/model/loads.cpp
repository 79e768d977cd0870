#include "core/dynamics/model/loads.h"

#include <algorithm>
#include <cmath>

namespace rigor {
namespace {

void add_force(int body, const Vec3& force, const Vec3& arm, Wrenches& out) {
  if (body == kWorld) return;
  out[body].force += force;
  out[body].torque += arm.cross(force);
}

// The force on b's point. Where the two points meet the line has no direction, and a spring of some rest length no
// force.
Vec3 spring_force(const Spring& spring, const PointMotion& a, const PointMotion& b) {
  const Vec3 line = b.position - a.position;
  const double length = line.norm();
  if (length == 0) return Vec3::Zero();
  const Vec3 direction = line / length;
  const double stretching = direction.dot(b.velocity - a.velocity);
  return -(spring.stiffness * (length - spring.rest_length) + spring.damping * stretching) * direction;
}

}  // namespace

PointMotion point_motion(BodyColumns bodies, int body, const Vec3& point) {
  if (body == kWorld) return {point, point, Vec3::Zero()};
  const Vec3 arm = bodies.rotation(body) * point;
  return {arm, bodies.position(body) + arm, bodies.velocity(body) + bodies.angular_velocity(body).cross(arm)};
}

double share_of_step(const TimedForce& force, double t, double dt) {
  if (dt == 0) return t >= force.from && t < force.until ? 1 : 0;
  const double first = std::min(t, t + dt), last = std::max(t, t + dt);
  const double overlap = std::min(force.until, last) - std::max(force.from, first);
  return std::clamp(overlap / std::abs(dt), 0.0, 1.0);
}

Loads::Loads(const Scene& scene)
    : gravity_(scene.gravity), springs_(scene.springs), forces_(scene.forces), schedule_(scene.forces) {
  for (const Body& body : scene.bodies) masses_.push_back(body.fixed ? 0 : body.mass);
  damped_ = std::any_of(springs_.begin(), springs_.end(), [](const Spring& s) { return s.damping > 0; });
}

void Loads::evaluate(BodyColumns bodies, double t, double dt, Wrenches& out) const {
  out.assign(bodies.size(), Wrench{});
  for (const Spring& spring : springs_) {
    const PointMotion a = point_motion(bodies, spring.a, spring.point_a),
                      b = point_motion(bodies, spring.b, spring.point_b);
    const Vec3 force = spring_force(spring, a, b);
    add_force(spring.a, -force, a.arm, out);
    add_force(spring.b, force, b.arm, out);
  }
  for_each_acting(t, dt, [&](const TimedForce& force, double share) {
    add_force(force.body, share * force.force, bodies.rotation(force.body) * force.point, out);
    out[force.body].torque += share * force.torque;
  });
}

void Loads::evaluate_with_gravity(BodyColumns bodies, double t, double dt, Wrenches& out) const {
  evaluate(bodies, t, dt, out);
  for (std::size_t i = 0; i < masses_.size(); ++i) out[i].force += masses_[i] * gravity_;
}

}  // namespace rigor
