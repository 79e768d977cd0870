#include "core/scene/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/base/eigen_of.h"
#include "core/base/error.h"

namespace rigor {
namespace {

using Fault = std::optional<SceneFault>;

bool is_body(int index, const Scene& scene) { return index >= 0 && index < static_cast<int>(scene.bodies.size()); }
bool can_move(int index, const Scene& scene) { return index != kWorld && !scene.bodies[index].fixed; }

Fault not_at_least_zero(const char* key, double value) {
  if (value >= 0 && std::isfinite(value)) return {};
  return SceneFault{key, fmt::format("found {}; allowed: a number of at least 0", value)};
}

Fault fault_of_field(const char* key, ShapeQuantity quantity, double value) {
  if (std::isfinite(value) && (quantity == ShapeQuantity::number || value > 0)) return {};
  return SceneFault{"shape", fmt::format("its {} is {}; allowed: a number greater than 0", key, value)};
}
Fault fault_of_field(const char* key, ShapeQuantity quantity, const Vec3& value) {
  if (quantity != ShapeQuantity::direction) return fault_of_field(key, ShapeQuantity::length, value.minCoeff());
  if (is_unit(value.squaredNorm())) return {};
  return SceneFault{"shape", fmt::format("its {} is no unit vector", key)};
}

Fault fault_of_shape(const Shape& shape) {
  Fault fault;
  for_each_field(shape, [&](const char* key, ShapeQuantity quantity, const auto& value) {
    if (!fault) fault = fault_of_field(key, quantity, value);
  });
  if (const auto* convex = std::get_if<Convex>(&shape); convex && !convex->hull)
    return SceneFault{"shape", "a convex shape has no hull"};
  if (fault || !std::holds_alternative<Compound>(shape)) return fault;
  const std::vector<PlacedShape>& parts = std::get<Compound>(shape).parts;
  if (parts.empty()) return SceneFault{"shapes", "found none; allowed: at least one shape"};
  for (const PlacedShape& part : parts) {
    if (!shape_types()[part.shape.index()].is_solid)
      return SceneFault{"shapes", fmt::format("a {} cannot be one of several shapes", shape_name(part.shape))};
    if (!part.pose.position.allFinite() || !is_unit(part.pose.orientation.squaredNorm()))
      return SceneFault{"shapes", "a shape's pose is not finite, or its orientation no unit quaternion"};
    if (Fault of_part = fault_of_shape(part.shape)) return of_part;
  }
  return fault;
}

Fault fault_of_motion(const Body& body) {
  if (!body.position.allFinite()) return SceneFault{"position", "it is not finite"};
  if (!is_unit(body.orientation.squaredNorm())) return SceneFault{"orientation_wxyz", "it is no unit quaternion"};
  for (const auto& [key, rate] : {std::pair{"velocity", body.velocity}, {"angular_velocity", body.angular_velocity}}) {
    if (!rate.allFinite()) return SceneFault{key, "it is not finite"};
    if (body.fixed && !rate.isZero(0))
      return SceneFault{key, "a fixed body does not move; allowed: [0, 0, 0], or no such key"};
  }
  return {};
}

Fault fault_of_times(double from, double until) {
  if (const Fault early = not_at_least_zero("from", from)) return early;
  if (until > from) return {};
  return SceneFault{"until", fmt::format("found {}; allowed: a time after from, which is {} s", until, from)};
}

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

template <typename Rows, typename F>
void check_rows(const Rows& rows, const F& fault_and_name) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto [fault, name] = fault_and_name(rows[i], i);
    if (!fault) continue;
    throw InputError(fmt::format("{}: {}{}{}", name, fault->key, fault->key.empty() ? "" : ": ", fault->what));
  }
}

}  // namespace

std::string why_no_inertia(const Mat3& inertia) {
  if (!inertia.allFinite()) return "its moments are not finite";
  const Vec3 moments = eigen_of(inertia).values;  // ascending
  const double largest = moments[2];
  // The eigenvalues of a singular matrix come out as a few roundings of the largest instead of 0.
  constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
  const std::string found =
      fmt::format("its principal moments are {:.6g}, {:.6g} and {:.6g} kg m²", moments[0], moments[1], moments[2]);
  if (!(moments[0] > kRounding * largest)) return found + ", and each must be greater than 0";
  // A flat body's largest moment is the sum of the others. Written with six digits, each has an error of at most 5e-6
  // of itself, so the sum's error is at most 1e-5 of the largest.
  constexpr double kWrittenDigits = 1e-5;
  if (largest - moments[1] > moments[0] + kWrittenDigits * largest)
    return found + ", and none may be greater than the sum of the other two";
  return "";
}

Fault fault_of_name(const std::string& body) {
  if (body.empty()) return SceneFault{"name", "it is empty"};
  if (body != "world") return {};
  return SceneFault{"name", "'world' is the name of the world itself; allowed: any other name"};
}

Fault fault_of(const Body& body) {
  if (const Fault name = fault_of_name(body.name)) return name;
  const bool is_plane = body.shape && std::holds_alternative<Plane>(*body.shape);
  if (body.shape) {
    if (Fault shape = fault_of_shape(*body.shape)) return shape;
  }
  if (is_plane && !body.fixed)
    return SceneFault{"fixed", "found false, but a plane never moves; allowed: true, or no such key"};
  if (is_plane && !body.position.isZero(0))
    return SceneFault{"position", "a plane lies where its normal and offset say, not at a position"};
  if (body.collides && !body.shape)
    return SceneFault{"collides", "found true, but the body has no shape to collide with; allowed: false"};
  if (!body.fixed && !(body.mass > 0 && std::isfinite(body.mass)))
    return SceneFault{"mass", fmt::format("found {}; allowed: a number greater than 0", body.mass)};
  const std::string why = body.fixed ? "" : why_no_inertia(body.inertia);
  if (!why.empty()) return SceneFault{"inertia", "no body has this inertia: " + why};
  return fault_of_motion(body);
}

Fault fault_of_ends(int a, int b, const char* what, const Scene& scene) {
  for (const auto& [key, end] : {std::pair{"a", a}, {"b", b}}) {
    if (end != kWorld && !is_body(end, scene)) return SceneFault{key, fmt::format("there is no body number {}", end)};
  }
  if (a == b) return SceneFault{"b", fmt::format("a {} from '{}' to itself does nothing", what, scene.body_name(a))};
  if (can_move(a, scene) || can_move(b, scene)) return {};
  return SceneFault{"b", fmt::format("a {} from '{}' to '{}' does nothing, for neither can move", what,
                                     scene.body_name(a), scene.body_name(b))};
}

Fault fault_of(const Spring& spring, const Scene& scene) {
  if (Fault ends = fault_of_ends(spring.a, spring.b, "spring", scene)) return ends;
  for (const auto& [key, value] :
       {std::pair{"stiffness", spring.stiffness}, {"damping", spring.damping}, {"rest_length", spring.rest_length}}) {
    if (Fault negative = not_at_least_zero(key, value)) return negative;
  }
  if (spring.point_a.allFinite() && spring.point_b.allFinite()) return {};
  return SceneFault{"", "its points are not finite"};
}

Fault fault_of(const Joint& joint, const Scene& scene) {
  if (Fault ends = fault_of_ends(joint.a, joint.b, "joint", scene)) return ends;
  if (Fault vector = fault_of_vectors(joint)) return vector;
  if (Fault type = std::visit(JointFault{joint, scene}, joint.type)) return type;
  for (const auto& [key, value] : {std::pair{"stiffness", joint.stiffness}, {"damping", joint.damping}}) {
    if (Fault negative = not_at_least_zero(key, value)) return negative;
  }
  if (!std::isfinite(joint.rest)) return SceneFault{"rest", "it is not finite"};
  return fault_of_limits(joint);
}

Fault fault_of(const Motor& motor, const Scene& scene) {
  if (motor.joint < 0 || motor.joint >= static_cast<int>(scene.joints.size()))
    return SceneFault{"joint", fmt::format("there is no joint number {}", motor.joint)};
  if (!free_axis(scene.joints[motor.joint]))
    return SceneFault{
        "joint", fmt::format("is a {} joint, which has no coordinate of its own to drive; allowed: a hinge or a slider",
                             joint_type_name(scene.joints[motor.joint]))};
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
  for (const Motor& other : scene.motors) {
    const bool overlap =
        &other != &motor && other.joint == motor.joint && other.from < motor.until && motor.from < other.until;
    if (overlap && other.speed && motor.speed)
      return SceneFault{"speed",
                        other.is_friction || motor.is_friction
                            ? "the joint has friction, and that acts like a motor of speed 0; allowed: one of the two"
                            : "another motor prescribes the speed of the same joint at the same time"};
    if (overlap && other.servo && motor.servo)
      return SceneFault{"kp", "another servo drives the same joint at the same time; allowed: one at a time"};
  }
  return fault_of_times(motor.from, motor.until);
}

Fault fault_of(const ContactLaw& law) {
  if (!(law.restitution >= 0 && law.restitution <= 1))
    return SceneFault{"restitution", fmt::format("found {}; allowed: a number from 0 to 1", law.restitution)};
  if (!(law.friction >= 0))
    return SceneFault{"friction", fmt::format("found {}; allowed: a number of at least 0", law.friction)};
  for (const auto& [key, value] :
       {std::pair("rolling_friction", law.rolling_friction), std::pair("torsional_friction", law.torsional_friction),
        std::pair("stiffness", law.stiffness), std::pair("damping", law.damping)}) {
    if (!(value >= 0 && std::isfinite(value)))
      return SceneFault{key, fmt::format("found {}; allowed: a finite number of at least 0", value)};
  }
  if (law.damping > 0 && !law.is_soft())
    return SceneFault{"damping", "without stiffness the contact is rigid; allowed: stiffness, too"};
  if (law.is_soft() && law.restitution > 0)
    return SceneFault{"restitution", "the bounce of a soft contact follows from its damping; allowed: one of the two"};
  return {};
}

// A soft law belongs to one point, and other shapes have several.
Fault fault_of_soft(const ContactLaw& law, const Body& body) {
  if (!law.is_soft() || !body.collides || std::holds_alternative<Sphere>(*body.shape) ||
      std::holds_alternative<Plane>(*body.shape))
    return {};
  return SceneFault{"stiffness",
                    fmt::format("'{}' is no sphere or plane; allowed: a soft contact of those", body.name)};
}

Fault fault_of(const ContactPair& pair, const Scene& scene) {
  if (!is_body(pair.a, scene) || !is_body(pair.b, scene)) return SceneFault{"", "names a body that is not there"};
  if (pair.a == pair.b) return SceneFault{"b", fmt::format("'{}' cannot touch itself", scene.body_name(pair.a))};
  for (const int body : {pair.a, pair.b}) {
    if (const Fault fault = fault_of_soft(pair.law, scene.bodies[static_cast<std::size_t>(body)])) return fault;
  }
  return fault_of(pair.law);
}

Fault fault_of_default(const Scene& scene) {
  for (const Body& body : scene.bodies) {
    if (const Fault fault = fault_of_soft(scene.contact_default, body)) return fault;
  }
  return fault_of(scene.contact_default);
}

Fault fault_of(const TimedForce& force, const Scene& scene) {
  if (!is_body(force.body, scene)) return SceneFault{"body", "names a body that is not there"};
  if (!can_move(force.body, scene)) return SceneFault{"body", "the body is fixed, so no force can move it"};
  if (!force.force.allFinite() || !force.torque.allFinite() || !force.point.allFinite())
    return SceneFault{"", "it is not finite"};
  return fault_of_times(force.from, force.until);
}

void validate(const Scene& scene) {
  if (scene.bodies.empty()) throw InputError("there is no body; allowed: a scene of at least one");
  if (!scene.gravity.allFinite()) throw InputError("gravity: it is not finite");
  if (const Fault law = fault_of_default(scene)) throw InputError("contact_default: " + law->what);
  std::set<std::string> bodies, joints;
  std::set<std::pair<int, int>> pairs;
  check_rows(scene.bodies, [&](const Body& body, std::size_t) {
    Fault fault = fault_of(body);
    if (!fault && !bodies.insert(body.name).second) fault = SceneFault{"name", "another body has it, too"};
    return std::pair(fault, fmt::format("body '{}'", body.name));
  });
  check_rows(scene.springs, [&](const Spring& spring, std::size_t i) {
    return std::pair(fault_of(spring, scene), fmt::format("spring {}", i + 1));
  });
  check_rows(scene.joints, [&](const Joint& joint, std::size_t i) {
    Fault fault = fault_of(joint, scene);
    if (!fault && !joint.name.empty() && !joints.insert(joint.name).second)
      fault = SceneFault{"name", "another joint has it, too"};
    return std::pair(fault, fmt::format("joint {}", i + 1));
  });
  check_rows(scene.motors, [&](const Motor& motor, std::size_t i) {
    return std::pair(fault_of(motor, scene), fmt::format("motor {}", i + 1));
  });
  check_rows(scene.contact_pairs, [&](const ContactPair& pair, std::size_t i) {
    Fault fault = fault_of(pair, scene);
    if (!fault && !pairs.insert(std::minmax({pair.a, pair.b})).second)
      fault = SceneFault{"", "the pair is given twice; allowed: once, in either order"};
    return std::pair(fault, fmt::format("contact {}", i + 1));
  });
  check_rows(scene.forces, [&](const TimedForce& force, std::size_t i) {
    return std::pair(fault_of(force, scene), fmt::format("force {}", i + 1));
  });
}

}  // namespace rigor
