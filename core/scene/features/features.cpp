#include "core/scene/features/features.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/scene/contact_laws.h"

namespace rigor::inline scene {
namespace {

class NeedList {
 public:
  void add(Feature feature, const std::string& because) {
    if (seen_.insert(feature).second) needs_.push_back({feature, because});
  }
  std::vector<Need> take() { return std::move(needs_); }

 private:
  Features seen_;
  std::vector<Need> needs_;
};

Feature friction_feature(double friction) {
  if (friction == 0) return Feature::friction_none;
  return friction == kInfiniteFriction ? Feature::friction_infinite : Feature::friction_coulomb;
}

void add_contact_law(const ContactLaw& law, const std::string& because, NeedList& needs) {
  needs.add(friction_feature(law.friction), because);
  if (law.restitution > 0) needs.add(Feature::restitution, because);
  if (law.sticks_better()) needs.add(Feature::static_friction, because);
  if (law.rolling_friction > 0) needs.add(Feature::rolling_friction, because);
  if (law.torsional_friction > 0) needs.add(Feature::torsional_friction, because);
  if (law.is_soft()) needs.add(Feature::soft_contact, because);
  if (law.dissipation > 0) needs.add(Feature::hunt_crossley, because);
}

// The body's shapes, each once, by their place in the table; and whether the body is fixed.
using Kind = std::pair<std::set<int>, bool>;
Kind kind_of(const Body& body) {
  Kind kind{{}, body.fixed};
  for_each_part(*body.shape,
                [&](const Shape& shape, const BodyPose&) { kind.first.insert(static_cast<int>(shape.index())); });
  return kind;
}

std::pair<Kind, Kind> kinds_of(const Body& a, const Body& b) { return std::minmax({kind_of(a), kind_of(b)}); }

// By kinds: the number of pairs that could meet and that the scene keeps apart.
std::map<std::pair<Kind, Kind>, std::size_t> pairs_apart(const Scene& scene) {
  std::map<std::pair<Kind, Kind>, std::size_t> apart;
  for (const ContactPair& pair : scene.contact_pairs) {
    const Body &a = scene.bodies[pair.a], &b = scene.bodies[pair.b];
    if (!pair.law.collides && can_meet(a, b)) ++apart[kinds_of(a, b)];
  }
  return apart;
}

// The first pair of the two groups that may touch; at least one does.
std::pair<int, int> first_pair(const std::vector<int>& first, const std::vector<int>& second, const ContactLaws& laws) {
  for (const int a : first) {
    for (const int b : second) {
      if (a != b && laws.may_touch(a, b)) return {a, b};
    }
  }
  return {first.front(), second.front()};
}

// Groups bodies by shape and by whether they can move, so that ten thousand bodies need no pairwise search.
// Returns whether any two bodies may touch.
bool add_contacts(const Scene& scene, NeedList& needs) {
  std::map<Kind, std::vector<int>> groups;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    if (scene.bodies[i].collides) groups[kind_of(scene.bodies[i])].push_back(i);
  }
  const ContactLaws laws(scene);
  const auto apart = pairs_apart(scene);
  std::size_t pairs_that_touch = 0;
  std::string because;
  for (auto first = groups.begin(); first != groups.end(); ++first) {
    for (auto second = first; second != groups.end(); ++second) {
      if (first->first.second && second->first.second) continue;  // both are fixed
      const std::size_t one = first->second.size(), other = second->second.size();
      const auto kept = apart.find({first->first, second->first});
      const std::size_t all = first == second ? one * (one - 1) / 2 : one * other;
      const std::size_t touching = all - (kept == apart.end() ? 0 : kept->second);
      if (touching == 0) continue;
      const auto [a, b] = first_pair(first->second, second->second, laws);
      because = fmt::format("bodies '{}' and '{}' may touch", scene.bodies[a].name, scene.bodies[b].name);
      for (const int of_a : first->first.first) {
        for (const int of_b : second->first.first) needs.add(contact_feature(of_a, of_b), because);
      }
      pairs_that_touch += touching;
    }
  }
  if (pairs_that_touch == 0) return false;
  for (const Body& body : scene.bodies) {
    if (body.collides && std::holds_alternative<Compound>(*body.shape))
      needs.add(Feature::placed_shapes,
                fmt::format("body '{}' has several shapes, or one that is not centred,", body.name));
  }

  std::size_t laws_given = 0;
  for (const ContactPair& pair : scene.contact_pairs) {
    if (!can_meet(scene.bodies[pair.a], scene.bodies[pair.b])) continue;
    const std::string of_pair =
        fmt::format("the contact of '{}' and '{}'", scene.body_name(pair.a), scene.body_name(pair.b));
    if (!pair.law.collides) {
      needs.add(Feature::contact_filter, of_pair + ", which never touch,");
      continue;
    }
    ++laws_given;
    add_contact_law(pair.law, of_pair, needs);
  }
  if (laws_given < pairs_that_touch) add_contact_law(scene.contact_default, because, needs);
  return true;
}

void add_joint(const Scene& scene, std::size_t k, NeedList& needs) {
  const Joint& joint = scene.joints[k];
  const std::string because = scene.joint_name(k);
  if (!is_axis_of_compound(joint)) needs.add(joint_feature(joint.type), because);
  if (joint.armature > 0) needs.add(Feature::armature, because);
  if (joint.stiffness > 0) needs.add(Feature::joint_spring, because);
  if (joint.quadratic_stiffness > 0) needs.add(Feature::quadratic_spring, because);
  if (joint.damping > 0) needs.add(Feature::joint_damper, because);
  if (joint.has_limits()) needs.add(Feature::joint_limit, because);
  // A joint whose angle counts from -pi to pi never reaches such a limit.
  const bool beyond = (std::isfinite(joint.lower) && joint.lower < -std::numbers::pi) ||
                      (std::isfinite(joint.upper) && joint.upper > std::numbers::pi);
  if (beyond && turns(joint)) needs.add(Feature::joint_limit_beyond_half_turn, because);
}

bool is_damped(const Scene& scene) {
  const auto damps = [](const auto& row) { return row.damping != 0; };
  return std::any_of(scene.springs.begin(), scene.springs.end(), damps) ||
         std::any_of(scene.joints.begin(), scene.joints.end(), damps) ||
         std::any_of(scene.motors.begin(), scene.motors.end(), [](const Motor& motor) {
           return motor.servo && motor.servo->period == 0 && motor.servo->kd != 0;
         });
}

}  // namespace

Feature feature_of(const Motor& motor) {
  if (motor.is_friction) return Feature::joint_friction;
  if (motor.speed) return Feature::motor_speed;
  if (motor.servo) return motor.plus.empty() ? Feature::motor_servo : Feature::motor_servo_of_several_joints;
  return motor.efforts ? Feature::motor_table : Feature::motor_effort;
}

std::vector<Need> needs_of(const Scene& scene) {
  NeedList needs;
  for (const Body& body : scene.bodies) {
    const bool is_plane = body.shape && std::holds_alternative<Plane>(*body.shape);
    if (body.fixed && !is_plane) needs.add(Feature::fixed_body, fmt::format("body '{}' is fixed", body.name));
  }
  if (!scene.springs.empty()) {
    const Spring& spring = scene.springs.front();
    needs.add(Feature::spring,
              fmt::format("a spring between '{}' and '{}'", scene.body_name(spring.a), scene.body_name(spring.b)));
  }
  for (const Spring& spring : scene.springs) {
    if (spring.quadratic_stiffness > 0)
      needs.add(Feature::quadratic_spring,
                fmt::format("the spring between '{}' and '{}'", scene.body_name(spring.a), scene.body_name(spring.b)));
  }
  if (!scene.forces.empty()) {
    needs.add(Feature::timed_force, fmt::format("a force on '{}'", scene.body_name(scene.forces.front().body)));
  }
  for (std::size_t k = 0; k < scene.joints.size(); ++k) add_joint(scene, k, needs);
  for (std::size_t k = 0; k < scene.couplings.size(); ++k) {
    needs.add(Feature::coupling, scene.coupling_name(k));
    if (scene.couplings[k].to.size() > 1) needs.add(Feature::coupling_of_several_joints, scene.coupling_name(k));
  }
  for (const Motor& motor : scene.motors) {
    needs.add(feature_of(motor), fmt::format("{} {}{}",
                                             motor.is_friction ? "friction in"
                                             : motor.servo     ? "a servo on"
                                                               : "a motor on",
                                             scene.joint_name(static_cast<std::size_t>(motor.joint)),
                                             motor.plus.empty() ? "" : " and others"));
  }
  const bool touches = add_contacts(scene, needs);
  if (scene.joints.empty()) return needs.take();
  if (touches) needs.add(Feature::joints_with_contacts, "the scene, which has both joints and bodies that may touch,");
  for (std::size_t k = 0; touches && k < scene.joints.size(); ++k) {
    const Joint& joint = scene.joints[k];
    if (is_axis_of_compound(joint) && !turns(joint) && joint.has_limits())
      needs.add(Feature::joint_limit_of_compound_slider, scene.joint_name(k));
  }
  if (is_damped(scene)) needs.add(Feature::joints_with_dampers, "the scene, which has both joints and dampers,");
  return needs.take();
}

bool needs(const Scene& scene, Feature feature) {
  const std::vector<Need> all = needs_of(scene);
  return std::any_of(all.begin(), all.end(), [&](const Need& need) { return need.feature == feature; });
}

}  // namespace rigor::inline scene
