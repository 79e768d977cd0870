// The conditions of joints, couplings and motors.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "core/scene/joints/axis_series.h"
#include "core/scene/turn_window.h"
#include "core/scene/validate.h"

namespace rigor::inline scene {
namespace {

using Fault = std::optional<SceneFault>;

double distance(int a, const Vec3& point_a, int b, const Vec3& point_b, const Scene& scene) {
  const BodyPose pose_a = scene.pose(a), pose_b = scene.pose(b);
  return (pose_b.position + pose_b.orientation * point_b - pose_a.position - pose_a.orientation * point_a).stableNorm();
}

Fault fault_of_vectors(const Joint& joint) {
  Fault fault;
  for_each_vector(joint.type, [&](const char* key, JointVector kind, const Vec3& vector) {
    if (fault) return;
    if (kind == JointVector::point && !vector.allFinite()) fault = SceneFault{key, "it is not finite"};
    if (kind == JointVector::direction && !is_unit(vector.squaredNorm()))
      fault = SceneFault{key, "it is no unit vector"};
  });
  return fault;
}

// Faults that the vectors of a joint have together.
struct JointFault {
  const Joint& joint;
  const Scene& scene;

  Fault operator()(const DistanceJoint& type) const {
    const double apart = distance(joint.a, type.point_a, joint.b, type.point_b, scene);
    if (!(apart > 0)) {
      return SceneFault{"point_b",
                        "the two points coincide at t = 0, so their distance has no direction; allowed: points apart"};
    }
    if (!std::isfinite(apart)) return SceneFault{"", "the distance between its ends is too large for a number"};
    return {};
  }
  Fault operator()(const UniversalJoint& type) const {
    // Six digits written of each component leave so much of a right angle.
    constexpr double kRight = 1e-5;
    const double cosine = type.axis.dot(type.axis2);
    if (std::abs(cosine) <= kRight) return {};
    return SceneFault{"axis2", fmt::format("found an angle of {:.6g}° to axis; allowed: a right angle",
                                           std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / M_PI)};
  }
  Fault operator()(const CompoundJoint& type) const {
    const std::string why = why_no_series(type.axes);
    return why.empty() ? Fault{} : SceneFault{"axes", why};
  }
  Fault operator()(const CompoundAxis& type) const {
    if (type.index < type.axes.size()) return {};
    return SceneFault{"", fmt::format("is axis {} of a compound joint of {}", type.index + 1, type.axes.size())};
  }
  Fault operator()(const ScrewJoint& type) const {
    if (std::isfinite(type.pitch) && type.pitch != 0) return {};
    return SceneFault{"pitch", fmt::format("found {}; allowed: a number other than 0, in m per turn", type.pitch)};
  }
  template <typename Other>
  Fault operator()(const Other&) const {
    return {};
  }
};

Fault fault_of_table(const TimeTable& table, const char* key) {
  if (table.times.empty() || table.times.size() != table.values.size())
    return SceneFault{key, "allowed: at least one time, and a value for each"};
  for (std::size_t i = 0; i < table.times.size(); ++i) {
    if (!std::isfinite(table.times[i]) || !std::isfinite(table.values[i])) return SceneFault{key, "it is not finite"};
    if (i > 0 && !(table.times[i] > table.times[i - 1]))
      return SceneFault{
          key, fmt::format("found the time {} after {}; allowed: times that rise", table.times[i], table.times[i - 1])};
  }
  return {};
}

Fault fault_of_servo(const Servo& servo) {
  for (const auto& [key, value] : {std::pair{"kp", servo.kp}, {"kd", servo.kd}, {"period", servo.period}}) {
    if (const Fault negative = not_at_least_zero(key, value)) return negative;
  }
  if (!std::isfinite(servo.target_speed)) return SceneFault{"target_speed", "it is not finite"};
  if (!(servo.most > 0))
    return SceneFault{"most", fmt::format("found {}; allowed: a number greater than 0", servo.most)};
  return fault_of_table(servo.target, "target");
}

Fault fault_of_limits(const Joint& joint) {
  if (!(joint.lower < joint.upper)) {
    return SceneFault{"upper", fmt::format("found {}, and lower is {}; allowed: limits of which the upper is greater",
                                           joint.upper, joint.lower)};
  }
  if (joint.lower > 0) return SceneFault{"lower", fmt::format("the joint is at 0 at t = 0, {} below it", joint.lower)};
  if (joint.upper < 0) return SceneFault{"upper", fmt::format("the joint is at 0 at t = 0, {} above it", -joint.upper)};
  if (joint.restitution >= 0 && joint.restitution <= 1) return {};
  return SceneFault{"restitution", fmt::format("found {}; allowed: a number from 0 to 1", joint.restitution)};
}

}  // namespace

Fault fault_of(const Joint& joint, const Scene& scene) {
  if (Fault ends = fault_of_ends(joint.a, joint.b, "joint", scene)) return ends;
  if (Fault vector = fault_of_vectors(joint)) return vector;
  if (Fault type = std::visit(JointFault{joint, scene}, joint.type)) return type;
  for (const auto& [key, value] : {std::pair{"stiffness", joint.stiffness},
                                   {"damping", joint.damping},
                                   {"armature", joint.armature},
                                   {"quadratic_stiffness", joint.quadratic_stiffness}}) {
    if (Fault negative = not_at_least_zero(key, value)) return negative;
  }
  if (Fault alone = fault_of_quadratic(joint.stiffness, joint.quadratic_stiffness)) return alone;
  if (joint.armature > 0 && !free_axis(joint))
    return SceneFault{"armature",
                      fmt::format("is on a {} joint; allowed: on a hinge, a slider or an axis of a compound "
                                  "joint",
                                  joint_type_name(joint))};
  if (!std::isfinite(joint.rest)) return SceneFault{"rest", "it is not finite"};
  return fault_of_limits(joint);
}

namespace {

Fault fault_of_coordinate(const char* key, int joint, const Scene& scene) {
  if (joint < 0 || joint >= static_cast<int>(scene.joints.size()))
    return SceneFault{key, fmt::format("there is no joint number {}", joint)};
  if (free_axis(scene.joints[joint])) return {};
  return SceneFault{key, fmt::format("is a {} joint, which has no coordinate of its own; allowed: a hinge, a slider "
                                     "or an axis of a compound joint",
                                     joint_type_name(scene.joints[joint]))};
}

// Of the joint and the terms, each a joint of its own.
Fault fault_of_terms(int joint, const char* key, const std::vector<JointTerm>& terms, const Scene& scene) {
  if (const Fault first = fault_of_coordinate("joint", joint, scene)) return first;
  std::set<int> seen;
  for (const JointTerm& term : terms) {
    if (const Fault coordinate = fault_of_coordinate(key, term.joint, scene)) return coordinate;
    if (term.joint == joint) return SceneFault{key, "is the same joint; allowed: another one"};
    if (!seen.insert(term.joint).second)
      return SceneFault{key, fmt::format("names {} twice; allowed: each joint once",
                                         scene.joint_name(static_cast<std::size_t>(term.joint)))};
    if (!std::isfinite(term.ratio) || term.ratio == 0)
      return SceneFault{"ratio", fmt::format("found {}; allowed: a number other than 0", term.ratio)};
  }
  return {};
}

// A sum of angles is known only where each angle is: between limits less than a turn apart.
Fault fault_of_angles(int joint, const char* key, const std::vector<JointTerm>& terms, const Scene& scene) {
  const auto fault = [&](const char* of, int k) -> Fault {
    const Joint& one = scene.joints[k];
    if (!turns(one) || middle_of_turn(one)) return {};
    return SceneFault{of, fmt::format("{} may turn round, so its part of the sum is known up to whole turns only; "
                                      "allowed: lower and upper less than a turn apart",
                                      scene.joint_name(static_cast<std::size_t>(k)))};
  };
  if (const Fault first = fault("joint", joint)) return first;
  for (const JointTerm& term : terms)
    if (const Fault other = fault(key, term.joint)) return other;
  return {};
}

Fault fault_of_sum(const Motor& motor, const Scene& scene) {
  if (motor.plus.empty()) return {};
  if (!motor.servo)
    return SceneFault{"plus", "is for servos; allowed: kp and target, or a row with an effort for each joint"};
  if (motor.servo->period > 0)
    return SceneFault{"period", "a servo on several joints does not sample; allowed: no period"};
  if (std::isfinite(motor.servo->most))
    return SceneFault{"most", "a servo on several joints has no bound; allowed: no most"};
  return fault_of_angles(motor.joint, "plus", motor.plus, scene);
}

}  // namespace

Fault fault_of(const Motor& motor, const Scene& scene) {
  if (const Fault terms = fault_of_terms(motor.joint, "plus", motor.plus, scene)) return terms;
  if (!std::isfinite(motor.effort) || !std::isfinite(motor.speed.value_or(0)))
    return SceneFault{"", "what it drives by is not finite"};
  if (motor.speed && !(motor.most > 0))
    return SceneFault{"most", fmt::format("found {}; allowed: a number greater than 0", motor.most)};
  if (motor.efforts) {
    if (const Fault table =
            fault_of_table(motor.efforts.value(), turns(scene.joints[motor.joint]) ? "torque" : "force"))
      return table;
  }
  if (motor.servo) {
    if (const Fault servo = fault_of_servo(motor.servo.value())) return servo;
  }
  if (const Fault sum = fault_of_sum(motor, scene)) return sum;
  for (const Motor& other : scene.motors) {
    const bool overlap =
        &other != &motor && other.joint == motor.joint && other.from < motor.until && motor.from < other.until;
    if (overlap && other.speed && motor.speed)
      return SceneFault{"speed",
                        other.is_friction || motor.is_friction
                            ? "the joint has friction, and that acts like a motor of speed 0; allowed: one of the two"
                            : "another motor prescribes the speed of the same joint at the same time"};
    if (overlap && other.servo && motor.servo && other.plus.empty() && motor.plus.empty())
      return SceneFault{"kp", "another servo drives the same joint at the same time; allowed: one at a time"};
  }
  return fault_of_times(motor.from, motor.until);
}

namespace {

// The bodies at the ends of its joints, the world among them.
std::set<int> ends_of(const Coupling& coupling, const Scene& scene) {
  std::set<int> ends = {scene.joints[coupling.joint].a, scene.joints[coupling.joint].b};
  for (const JointTerm& term : coupling.to) ends.insert({scene.joints[term.joint].a, scene.joints[term.joint].b});
  return ends;
}

}  // namespace

Fault fault_of(const Coupling& coupling, const Scene& scene) {
  if (coupling.to.empty()) return SceneFault{"to", "names no joint; allowed: one or several"};
  if (const Fault terms = fault_of_terms(coupling.joint, "to", coupling.to, scene)) return terms;
  if (coupling.to.size() > 1) {
    if (const Fault angles = fault_of_angles(coupling.joint, "to", coupling.to, scene)) return angles;
    if (const std::size_t count = ends_of(coupling, scene).size(); count > kMostCoupledEnds)
      return SceneFault{"to", fmt::format("its joints hold {} bodies, the world included; allowed: at most {}", count,
                                          kMostCoupledEnds)};
  }
  // Twelve digits written of a start remain.
  constexpr double kClosed = 1e-9;  // rad, m
  if (!(std::abs(coupling.offset) <= kClosed))
    return SceneFault{"offset", fmt::format("found {}, but both coordinates are 0 at t = 0, so the start violates the "
                                            "coupling; allowed: 0",
                                            coupling.offset)};
  return {};
}

Fault fault_of_circle(const std::vector<Coupling>& couplings, std::size_t last, const Scene& scene) {
  std::vector<int> root(scene.joints.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int joint) {
    while (root[joint] != joint) joint = root[joint];
    return joint;
  };
  for (std::size_t k = 0; k <= last; ++k) {
    for (const JointTerm& term : couplings[k].to) {
      const int one = find(couplings[k].joint), other = find(term.joint);
      if (one == other && k == last)
        return SceneFault{"to",
                          fmt::format("{} and {} are coupled already, through other rows; allowed: couplings without "
                                      "a circle",
                                      scene.joint_name(static_cast<std::size_t>(couplings[k].joint)),
                                      scene.joint_name(static_cast<std::size_t>(term.joint)))};
      root[one] = other;
    }
  }
  return {};
}

}  // namespace rigor::inline scene
