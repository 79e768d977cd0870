#include "adapters/bullet/bullet_tree.h"

namespace rigor::inline adapters::bullet {
namespace {

class Forest {
 public:
  explicit Forest(const Scene& scene) : scene_(scene), joints_of_(scene.bodies.size()), seen_(scene.bodies.size()) {
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
      const Joint& joint = scene.joints[k];
      for (const int end : {joint.a, joint.b})
        if (!stands(end)) joints_of_[static_cast<std::size_t>(end)].push_back(static_cast<int>(k));
    }
  }

  std::vector<Tree> grow() {
    for (std::size_t k = 0; k < scene_.joints.size(); ++k) {
      const Joint& joint = scene_.joints[k];
      if (stands(joint.a) == stands(joint.b)) continue;
      add({kWorld, {{stands(joint.a) ? joint.b : joint.a, kWorld, static_cast<int>(k)}}});
    }
    for (int body = 0; body < static_cast<int>(scene_.bodies.size()); ++body)
      if (!stands(body) && !seen_[static_cast<std::size_t>(body)]) add({body, {}});
    return std::move(trees_);
  }

 private:
  bool stands(int body) const { return body == kWorld || scene_.bodies[static_cast<std::size_t>(body)].fixed; }

  void add(Tree tree) {
    if (tree.base != kWorld) extend(tree, tree.base);
    for (std::size_t n = 0; n < tree.branches.size(); ++n) extend(tree, tree.branches[n].body);
    trees_.push_back(std::move(tree));
  }

  void extend(Tree& tree, int body) {
    seen_[static_cast<std::size_t>(body)] = true;
    for (const int k : joints_of_[static_cast<std::size_t>(body)]) {
      const Joint& joint = scene_.joints[static_cast<std::size_t>(k)];
      const int other = joint.a == body ? joint.b : joint.a;
      if (stands(other) || seen_[static_cast<std::size_t>(other)]) continue;
      seen_[static_cast<std::size_t>(other)] = true;
      tree.branches.push_back({other, body, k});
    }
  }

  const Scene& scene_;
  std::vector<std::vector<int>> joints_of_;  // by body that moves
  std::vector<bool> seen_;
  std::vector<Tree> trees_;
};

}  // namespace

std::vector<Tree> trees_of(const Scene& scene) { return Forest(scene).grow(); }

}  // namespace rigor::inline adapters::bullet
