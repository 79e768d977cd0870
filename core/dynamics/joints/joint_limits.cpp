#include "core/dynamics/joints/joint_limits.h"

#include <cmath>
#include <limits>

namespace rigor::inline dynamics {

double peak_between(double x, double rate, double end_x, double end_rate, double h) {
  const double coming = -end_rate;
  if (!(rate > 0 && coming > 0)) return -std::numeric_limits<double>::infinity();
  const double from_start = x + rate * h, from_end = end_x + coming * h;
  return (from_start * coming + from_end * rate - rate * coming * h) / (rate + coming);
}

JointLimits::JointLimits(const Scene& scene) {
  for (const Joint& joint : scene.joints) {
    for (const auto& [bound, side] : {std::pair(joint.lower, 1), std::pair(joint.upper, -1)}) {
      if (std::isfinite(bound)) limits_.push_back({JointCoordinate(scene, joint), bound, side, joint.restitution});
    }
  }
}

double JointLimits::Limit::with_turns(const JointCoordinate::Value& at, double since) const {
  return coordinate.with_turns(at.x, x + 0.5 * since * (rate + at.rate));
}

JointLimits::Value JointLimits::at(std::size_t k, BodyColumns state, double since) const {
  const Limit& limit = limits_[k];
  const JointCoordinate::Value at = limit.coordinate.at(state);
  Value value;
  value.gap = limit.side * (limit.with_turns(at, since) - limit.bound);
  value.rate = limit.side * at.rate, value.bias = limit.side * at.bias;
  value.is_of_turning = limit.coordinate.turns();
  value.direction = limit.side * (value.is_of_turning ? at.torque_b : at.force);
  if (value.is_of_turning) return value;
  // Both efforts act along the line through the centre of the joint's b: see JointCoordinate.
  const auto centre = [&](int body) { return body == kWorld ? Vec3::Zero().eval() : state.position(body); };
  value.arm_b = centre(a(k)) - centre(b(k));
  return value;
}

void JointLimits::note(BodyColumns state, double since) {
  for (Limit& limit : limits_) {
    const JointCoordinate::Value at = limit.coordinate.at(state);
    limit.x = limit.with_turns(at, since), limit.rate = at.rate;
  }
}

}  // namespace rigor::inline dynamics
