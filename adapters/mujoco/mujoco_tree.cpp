#include "adapters/mujoco/mujoco_tree.h"

#include <algorithm>
#include <numeric>

namespace rigor {
namespace {

// Bodies that hang together, and the world, as sets that are joined.
class Clusters {
 public:
  explicit Clusters(const Scene& scene) : of_(scene.bodies.size() + 1) {
    std::iota(of_.begin(), of_.end(), 0);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (scene.bodies[i].fixed) of_[i + 1] = 0;
    }
  }
  bool join(int a, int b) {  // false if they were one already
    const int first = find(a + 1), second = find(b + 1);
    of_[std::max(first, second)] = std::min(first, second);
    return first != second;
  }

 private:
  int find(int i) {
    while (of_[i] != i) i = of_[i] = of_[of_[i]];
    return i;
  }
  std::vector<int> of_;
};

int rank_of(const Joint& joint) {  // the least is taken first
  const std::string type = joint_type_name(joint);
  const std::vector<std::string> order = {"slider", "universal", "hinge", "fixed", "ball"};
  return static_cast<int>(std::find(order.begin(), order.end(), type) - order.begin());
}

bool moves(const Scene& scene, int body) { return body != kWorld && !scene.bodies[body].fixed; }

// The joints of the forest, by body at either end.
struct Neighbour {
  int body, joint;
};
using Neighbours = std::vector<std::vector<Neighbour>>;  // by body + 1; the world is first

Neighbours span(const Scene& scene, std::vector<int>& loops) {
  std::vector<int> joints(scene.joints.size());
  std::iota(joints.begin(), joints.end(), 0);
  std::stable_sort(joints.begin(), joints.end(),
                   [&](int a, int b) { return rank_of(scene.joints[a]) < rank_of(scene.joints[b]); });
  Clusters clusters(scene);
  Neighbours neighbours(scene.bodies.size() + 1);
  for (const int k : joints) {
    const Joint& joint = scene.joints[k];
    const int a = moves(scene, joint.a) ? joint.a : kWorld, b = moves(scene, joint.b) ? joint.b : kWorld;
    if (std::holds_alternative<DistanceJoint>(joint.type) || !clusters.join(a, b)) {
      loops.push_back(k);
      continue;
    }
    neighbours[a + 1].push_back({b, k});
    neighbours[b + 1].push_back({a, k});
  }
  return neighbours;
}

}  // namespace

MujocoTree mujoco_tree(const Scene& scene) {
  MujocoTree tree;
  const Neighbours neighbours = span(scene, tree.loops);
  tree.links.resize(scene.bodies.size());
  tree.below.resize(scene.bodies.size());
  std::vector<bool> reached(scene.bodies.size(), false);
  std::vector<int> waiting;
  const auto hang = [&](int parent) {
    for (const auto& [body, joint] : neighbours[parent + 1]) {
      if (body == kWorld || reached[body]) continue;
      tree.links[body] = {parent, joint};
      (parent == kWorld ? tree.roots : tree.below[parent]).push_back(body);
      reached[body] = true, waiting.push_back(body);
    }
  };
  const auto hang_all = [&] {
    while (!waiting.empty()) {
      const int body = waiting.back();
      waiting.pop_back();
      hang(body);
    }
  };
  hang(kWorld);
  hang_all();
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    if (scene.bodies[i].fixed || reached[i]) continue;
    tree.roots.push_back(i), waiting.push_back(i), reached[i] = true;
    hang_all();
  }
  return tree;
}

}  // namespace rigor
