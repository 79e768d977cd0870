#include "core/scene/features.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
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

std::string joint_feature(const Joint& joint) {
  constexpr const char* kNames[] = {"joint:ball", "joint:hinge", "joint:slider", "joint:fixed", "joint:distance"};
  return kNames[joint.type.index()];
}

bool may_touch(const Body& a, const Body& b) { return a.collides && b.collides && !(a.fixed && b.fixed); }

void add_contact_law(const ContactLaw& law, const std::string& because, NeedList& needs) {
  needs.add(friction_feature(law.friction), because);
  if (law.restitution > 0) needs.add("restitution", because);
}

// Bodies are grouped by shape and by whether they can move, so that ten thousand of them cost no pairwise search.
void add_contacts(const Scene& scene, NeedList& needs) {
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
  if (!some_pair_has_the_default) return;

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
  for (const Joint& joint : scene.joints) {
    needs.add(joint_feature(joint),
              fmt::format("a joint between '{}' and '{}'", scene.body_name(joint.a), scene.body_name(joint.b)));
  }
  add_contacts(scene, needs);
  return needs.take();
}

}  // namespace rigor
