#include "core/scene/joint_rates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/scene/joints/axis_series.h"

namespace rigor::inline scene {
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

// The speeds along the motions that the joint locks.
struct RatesOf {
  const Joint& joint;
  Motion a, b;

  JointRates operator()(const UniversalJoint& universal) const {
    return {speed_at(universal.anchor).norm(), std::abs(turning().dot(universal.axis.cross(universal.axis2)))};
  }
  JointRates operator()(const DistanceJoint& distance) const {
    const Vec3 from = a.in_world(distance.point_a), to = b.in_world(distance.point_b);
    return {std::abs((to - from).stableNormalized().dot(b.velocity_at(to) - a.velocity_at(from))), 0};
  }
  JointRates operator()(const CompoundAxis&) const { return {}; }
  JointRates operator()(const CompoundJoint& compound) const {
    const AxisSeries::Rows rows =
        AxisSeries(compound.axes, {a.position, a.orientation}, {b.position, b.orientation}).at(end(a), end(b));
    JointRates rates;
    for (int k = 0; k < rows.count; ++k) {
      const AxisSeries::Row& row = rows.locked[static_cast<std::size_t>(k)];
      double& out = row.force.isZero(0) ? rates.turn_rate : rates.speed;
      out = std::hypot(out, row.rate);
    }
    return rates;
  }
  JointRates operator()(const PlanarJoint& planar) const {
    const Vec3 v = b.velocity_at(planar.anchor) - a.velocity_at(planar.anchor);
    return {std::abs(planar.normal.dot(v)), across(turning(), planar.normal).norm()};
  }
  JointRates operator()(const ScrewJoint& screw) const {
    const Vec3 v = speed_at(screw.anchor);
    const double off_thread = screw.axis.dot(v) - screw.pitch / (2 * std::numbers::pi) * screw.axis.dot(turning());
    return {std::hypot(across(v, screw.axis).norm(), off_thread), across(turning(), screw.axis).norm()};
  }
  template <typename Type>
  JointRates operator()(const Type&) const {
    constexpr unsigned locks = Type::descriptor().locks.value();
    const Vec3 *anchor = anchor_of(joint), *axis = axis_of(joint);
    return {locked_part(speed_at(anchor ? *anchor : b.position), axis, locks & Lock::shifts, Lock::across),
            locked_part(turning(), axis, locks & Lock::turns, Lock::tilt)};
  }

 private:
  Vec3 speed_at(const Vec3& point) const { return b.velocity_at(point) - a.velocity_at(point); }
  static SeriesEnd end(const Motion& motion) {
    return {motion.position, motion.velocity, motion.angular_velocity, matrix_of(motion.orientation)};
  }
  Vec3 turning() const { return b.angular_velocity - a.angular_velocity; }
  static double locked_part(const Vec3& rate, const Vec3* axis, unsigned locks, unsigned across_axis) {
    if (locks == 0) return 0;
    return (locks == across_axis ? across(rate, *axis) : rate).norm();
  }
};

}  // namespace

// Of a joint's free coordinate [rad/s, m/s].
static double initial_coordinate_rate(const Scene& scene, const Joint& joint) {
  const Motion a(scene, joint.a), b(scene, joint.b);
  if (const auto* axis = std::get_if<CompoundAxis>(&joint.type)) {
    const auto end = [](const Motion& m) {
      return SeriesEnd{m.position, m.velocity, m.angular_velocity, matrix_of(m.orientation)};
    };
    return AxisSeries(axis->axes, {a.position, a.orientation}, {b.position, b.orientation})
        .at(end(a), end(b))
        .coordinates[axis->index]
        .rate;
  }
  const Vec3& axis = *free_axis(joint);
  if (turns(joint)) return axis.dot(b.angular_velocity - a.angular_velocity);
  return axis.dot(b.velocity - a.velocity_at(b.position));
}

std::string why_rates_break(const Scene& scene, const Coupling& coupling) {
  const auto rate_of = [&](int joint) {
    return initial_coordinate_rate(scene, scene.joints[static_cast<std::size_t>(joint)]);
  };
  const double rate = rate_of(coupling.joint);
  double sum = 0, size = std::abs(rate);
  std::string terms;
  for (const JointTerm& term : coupling.to) {
    const double to = rate_of(term.joint);
    sum += term.ratio * to, size += std::abs(term.ratio * to);
    terms += fmt::format("{}{:.6g} times {:.6g}", terms.empty() ? "" : " + ", term.ratio, to);
  }
  if (std::abs(rate - sum) <= kNoRate * (1 + size)) return "";
  return fmt::format("the initial velocities break it: its joint's rate is {:.6g}, and the others give {}", rate,
                     terms);
}

JointRates initial_rates(const Scene& scene, const Joint& joint) {
  return std::visit(RatesOf{joint, Motion(scene, joint.a), Motion(scene, joint.b)}, joint.type);
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

}  // namespace rigor::inline scene
