#include "core/scene/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/base/eigen_of.h"
#include "core/base/error.h"

namespace rigor::inline scene {
namespace {

using Fault = std::optional<SceneFault>;

bool is_body(int index, const Scene& scene) { return index >= 0 && index < static_cast<int>(scene.bodies.size()); }
bool can_move(int index, const Scene& scene) { return index != kWorld && !scene.bodies[index].fixed; }

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
  if (const SurfaceShape* on = surface_in(shape); on && !on->surface)
    return SceneFault{"shape", fmt::format("a {} has no triangles", shape_name(shape))};
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

// Each compound joint has all its axes behind it, and no axis stands alone.
bool stands_behind_its_compound(const Scene& scene, std::size_t k) {
  const Joint& joint = scene.joints[k];
  const auto is_axis = [&](std::size_t at, const Joint& of, const std::vector<SeriesAxis>& axes, std::size_t index) {
    if (at >= scene.joints.size()) return false;
    const auto* axis = std::get_if<CompoundAxis>(&scene.joints[at].type);
    return axis && axis->index == index && axis->axes == axes && scene.joints[at].a == of.a &&
           scene.joints[at].b == of.b;
  };
  if (const auto* whole = std::get_if<CompoundJoint>(&joint.type)) {
    for (std::size_t i = 0; i < whole->axes.size(); ++i)
      if (!is_axis(k + 1 + i, joint, whole->axes, i)) return false;
  }
  const auto* axis = std::get_if<CompoundAxis>(&joint.type);
  if (!axis) return true;
  if (k < axis->index + 1) return false;
  const auto* whole = std::get_if<CompoundJoint>(&scene.joints[k - axis->index - 1].type);
  return whole && whole->axes == axis->axes;
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

Fault not_at_least_zero(const char* key, double value) {
  if (value >= 0 && std::isfinite(value)) return {};
  return SceneFault{key, fmt::format("found {}; allowed: a number of at least 0", value)};
}

Fault fault_of_quadratic(double stiffness, double quadratic_stiffness) {
  if (stiffness > 0 || quadratic_stiffness == 0) return {};
  return SceneFault{"quadratic_stiffness", "it adds to stiffness; allowed: a stiffness above 0, too"};
}

Fault fault_of_times(double from, double until) {
  if (const Fault early = not_at_least_zero("from", from)) return early;
  if (until > from) return {};
  return SceneFault{"until", fmt::format("found {}; allowed: a time after from, which is {} s", until, from)};
}

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
  if (body.shape && stands_still(*body.shape) && !body.fixed)
    return SceneFault{"fixed", fmt::format("found false, but a {} never moves; allowed: true, or no such key",
                                           shape_name(*body.shape))};
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
  for (const auto& [key, value] : {std::pair{"stiffness", spring.stiffness},
                                   {"damping", spring.damping},
                                   {"rest_length", spring.rest_length},
                                   {"quadratic_stiffness", spring.quadratic_stiffness}}) {
    if (Fault negative = not_at_least_zero(key, value)) return negative;
  }
  if (Fault alone = fault_of_quadratic(spring.stiffness, spring.quadratic_stiffness)) return alone;
  if (spring.point_a.allFinite() && spring.point_b.allFinite()) return {};
  return SceneFault{"", "its points are not finite"};
}

Fault fault_of(const ContactLaw& law) {
  if (!(law.restitution >= 0 && law.restitution <= 1))
    return SceneFault{"restitution", fmt::format("found {}; allowed: a number from 0 to 1", law.restitution)};
  if (!(law.friction >= 0))
    return SceneFault{"friction", fmt::format("found {}; allowed: a number of at least 0", law.friction)};
  for (const auto& [key, value] :
       {std::pair("static_friction", law.static_friction), std::pair("rolling_friction", law.rolling_friction),
        std::pair("torsional_friction", law.torsional_friction), std::pair("stiffness", law.stiffness),
        std::pair("damping", law.damping), std::pair("dissipation", law.dissipation)}) {
    if (!(value >= 0 && std::isfinite(value)))
      return SceneFault{key, fmt::format("found {}; allowed: a finite number of at least 0", value)};
  }
  if (law.static_friction > 0 && law.static_friction < law.friction)
    return SceneFault{"static_friction",
                      fmt::format("found {}, less than the friction of {}; allowed: as much, or more",
                                  law.static_friction, law.friction)};
  for (const auto& [key, value] : {std::pair("damping", law.damping), std::pair("dissipation", law.dissipation)}) {
    if (value > 0 && !law.is_soft())
      return SceneFault{key, "without stiffness the contact is rigid; allowed: stiffness, too"};
  }
  if (law.damping > 0 && law.dissipation > 0)
    return SceneFault{"dissipation", "damping and dissipation belong to different laws; allowed: one of the two"};
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
    if (!fault && !stands_behind_its_compound(scene, i))
      fault = SceneFault{"", "an axis of a compound joint stands behind that joint, in the order of its axes"};
    return std::pair(fault, fmt::format("joint {}", i + 1));
  });
  check_rows(scene.couplings, [&](const Coupling& coupling, std::size_t i) {
    Fault fault = fault_of(coupling, scene);
    if (!fault) fault = fault_of_circle(scene.couplings, i, scene);
    return std::pair(fault, fmt::format("coupling {}", i + 1));
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

}  // namespace rigor::inline scene
