#include "core/scene/joint_rates.h"

#include <fmt/format.h>

#include <algorithm>

namespace rigor {
namespace {

struct Motion {
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  Quat orientation = Quat::Identity();

  Motion(const Scene& scene, int body) {
    if (body == kWorld) return;
    const Body& of = scene.bodies[static_cast<std::size_t>(body)];
    position = of.position, orientation = of.orientation;
    if (!of.fixed) velocity = of.velocity, angular_velocity = of.angular_velocity;
  }
  Vec3 velocity_at(const Vec3& point_W) const { return velocity + angular_velocity.cross(point_W - position); }
  Vec3 in_world(const Vec3& point) const { return position + orientation * point; }
};

Vec3 across(const Vec3& v, const Vec3& axis) { return v - axis.dot(v) * axis; }

struct RatesOf {
  Motion a, b;

  double speed_at(const Vec3& anchor) const { return (b.velocity_at(anchor) - a.velocity_at(anchor)).norm(); }
  Vec3 turning() const { return b.angular_velocity - a.angular_velocity; }

  JointRates operator()(const BallJoint& joint) const { return {speed_at(joint.anchor), 0}; }
  JointRates operator()(const HingeJoint& joint) const {
    return {speed_at(joint.anchor), across(turning(), joint.axis).norm()};
  }
  JointRates operator()(const UniversalJoint& joint) const {
    return {speed_at(joint.anchor), std::abs(turning().dot(joint.axis.cross(joint.axis2)))};
  }
  JointRates operator()(const SliderJoint& joint) const {
    return {across(b.velocity - a.velocity_at(b.position), joint.axis).norm(), turning().norm()};
  }
  JointRates operator()(const FixedJoint&) const { return {speed_at(b.position), turning().norm()}; }
  JointRates operator()(const DistanceJoint& joint) const {
    const Vec3 from = a.in_world(joint.point_a), to = b.in_world(joint.point_b);
    return {std::abs((to - from).stableNormalized().dot(b.velocity_at(to) - a.velocity_at(from))), 0};
  }
};

}  // namespace

JointRates initial_rates(const Scene& scene, const Joint& joint) {
  return std::visit(RatesOf{Motion(scene, joint.a), Motion(scene, joint.b)}, joint.type);
}

std::string why_rates_break(const Scene& scene, const Joint& joint) {
  const Motion a(scene, joint.a), b(scene, joint.b);
  const JointRates rates = initial_rates(scene, joint);
  const double allowed =
      kNoRate *
      (1 + std::max({a.velocity.norm(), b.velocity.norm(), a.angular_velocity.norm(), b.angular_velocity.norm()}));
  if (rates.speed <= allowed && rates.turn_rate <= allowed) return "";
  return fmt::format("the initial velocities of '{}' and '{}' break it by {:.6g} m/s and {:.6g} rad/s",
                     scene.body_name(joint.a), scene.body_name(joint.b), rates.speed, rates.turn_rate);
}

}  // namespace rigor
