#include "core/scene/features.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace rigor {
namespace {

class NeedList {
 public:
  void add(const std::string& feature, const std::string& because) {
    if (seen_.insert(feature).second) needs_.push_back({feature, because});
  }
  std::vector<Need> take() { return std::move(needs_); }

 private:
  std::set<std::string> seen_;
  std::vector<Need> needs_;
};

std::string friction_feature(double friction) {
  if (friction == 0) return "friction:none";
  return friction == kInfiniteFriction ? "friction:infinite" : "friction:coulomb";
}

bool may_touch(const Body& a, const Body& b) { return a.collides && b.collides && !(a.fixed && b.fixed); }

void add_contact_law(const ContactLaw& law, const std::string& because, NeedList& needs) {
  needs.add(friction_feature(law.friction), because);
  if (law.restitution > 0) needs.add("restitution", because);
}

// Bodies are grouped by shape and by whether they can move, so that ten thousand of them cost no pairwise search.
// Returns whether any may touch.
bool add_contacts(const Scene& scene, NeedList& needs) {
  std::map<std::pair<std::string, bool>, std::vector<int>> groups;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[i];
    if (body.collides) groups[{shape_name(*body.shape), body.fixed}].push_back(i);
  }
  bool some_pair_has_the_default = false;
  std::string because;
  for (auto first = groups.begin(); first != groups.end(); ++first) {
    for (auto second = first; second != groups.end(); ++second) {
      if (first == second && first->second.size() < 2) continue;
      const int a = first->second.front(), b = first == second ? first->second[1] : second->second.front();
      if (!may_touch(scene.bodies[a], scene.bodies[b])) continue;
      because = fmt::format("bodies '{}' and '{}' may touch", scene.bodies[a].name, scene.bodies[b].name);
      needs.add(contact_feature(first->first.first, second->first.first), because);
      some_pair_has_the_default = true;
    }
  }
  if (!some_pair_has_the_default) return false;

  std::size_t laws_given = 0;
  for (const ContactPair& pair : scene.contact_pairs) {
    if (!may_touch(scene.bodies[pair.a], scene.bodies[pair.b])) continue;
    ++laws_given;
    add_contact_law(
        pair.law, fmt::format("the contact of '{}' and '{}'", scene.body_name(pair.a), scene.body_name(pair.b)), needs);
  }
  std::size_t moving = 0, standing = 0;
  for (const auto& [key, members] : groups) (key.second ? standing : moving) += members.size();
  if (laws_given < moving * (moving - 1) / 2 + moving * standing)
    add_contact_law(scene.contact_default, because, needs);
  return true;
}

void add_joint(const Scene& scene, std::size_t k, NeedList& needs) {
  const Joint& joint = scene.joints[k];
  const std::string because = scene.joint_name(k);
  needs.add("joint:" + joint_type_name(joint), because);
  if (joint.stiffness > 0) needs.add("joint-spring", because);
  if (joint.damping > 0) needs.add("joint-damper", because);
  if (joint.has_limits()) needs.add("joint-limit", because);
  // What counts a hinge's angle from -pi to pi never comes to such a limit.
  const bool beyond = (std::isfinite(joint.lower) && joint.lower < -std::numbers::pi) ||
                      (std::isfinite(joint.upper) && joint.upper > std::numbers::pi);
  if (beyond && turns(joint)) needs.add("joint-limit:beyond-half-turn", because);
}

bool is_damped(const Scene& scene) {
  const auto damps = [](const auto& row) { return row.damping != 0; };
  return std::any_of(scene.springs.begin(), scene.springs.end(), damps) ||
         std::any_of(scene.joints.begin(), scene.joints.end(), damps);
}

}  // namespace

std::string contact_feature(const std::string& shape_a, const std::string& shape_b) {
  const auto [first, second] = std::minmax(shape_a, shape_b);
  return fmt::format("contact:{}-{}", first, second);
}

Features contacts_of_all_shapes() {
  const std::vector<std::string> solids = {"box", "capsule", "sphere"};
  Features contacts;
  for (const std::string& solid : solids) {
    contacts.insert(contact_feature(solid, "plane"));
    for (const std::string& other : solids) contacts.insert(contact_feature(solid, other));
  }
  return contacts;
}

Features joints_of_all_types() {
  Features joints;
  for (const JointTypeInfo& type : joint_types()) joints.insert("joint:" + type.word);
  return joints;
}

Features joined(Features a, const Features& b) {
  a.insert(b.begin(), b.end());
  return a;
}

std::vector<Need> needs_of(const Scene& scene) {
  NeedList needs;
  for (const Body& body : scene.bodies) {
    const bool is_plane = body.shape && std::holds_alternative<Plane>(*body.shape);
    if (body.fixed && !is_plane) needs.add("fixed-body", fmt::format("body '{}' is fixed", body.name));
  }
  if (!scene.springs.empty()) {
    const Spring& spring = scene.springs.front();
    needs.add("spring",
              fmt::format("a spring between '{}' and '{}'", scene.body_name(spring.a), scene.body_name(spring.b)));
  }
  if (!scene.forces.empty()) {
    needs.add("timed-force", fmt::format("a force on '{}'", scene.body_name(scene.forces.front().body)));
  }
  for (std::size_t k = 0; k < scene.joints.size(); ++k) add_joint(scene, k, needs);
  for (const Motor& motor : scene.motors) {
    needs.add(motor.speed ? "motor:speed" : "motor:effort",
              fmt::format("a motor on {}", scene.joint_name(static_cast<std::size_t>(motor.joint))));
  }
  const bool touches = add_contacts(scene, needs);
  if (scene.joints.empty()) return needs.take();
  if (touches) needs.add("joints-with-contacts", "the scene, which has both joints and bodies that may touch,");
  if (is_damped(scene)) needs.add("joints-with-dampers", "the scene, which has both joints and dampers,");
  return needs.take();
}

}  // namespace rigor
