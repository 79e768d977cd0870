#include "core/scene/joint_loops.h"

#include <algorithm>
#include <utility>

namespace rigor::inline scene {
namespace {

// Finds the bridges of the graph of bodies and joints (R. E. Tarjan, "A note on finding the bridges of a graph", 1974).
class Bridges {
 public:
  explicit Bridges(const Scene& scene) : scene_(scene), edges_(scene.bodies.size() + 1), on_loop_(scene.joints.size()) {
    for (std::size_t joint = 0; joint < scene.joints.size(); ++joint) {
      if (is_axis_of_compound(scene.joints[joint])) continue;
      edges_[node(scene.joints[joint].a)].push_back(joint);
      edges_[node(scene.joints[joint].b)].push_back(joint);
    }
    number_.assign(edges_.size(), 0), lowest_.assign(edges_.size(), 0);
  }

  std::vector<bool> joints_on_loops() {
    for (std::size_t start = 0; start < edges_.size(); ++start) {
      if (number_[start] == 0) visit_from(start);
    }
    return on_loop_;
  }

 private:
  struct Visit {
    std::size_t node, by_joint, next_edge;
  };

  std::size_t node(int body) const {
    const bool stands = body == kWorld || scene_.bodies[static_cast<std::size_t>(body)].fixed;
    return stands ? scene_.bodies.size() : static_cast<std::size_t>(body);
  }

  std::size_t other_end(std::size_t joint, std::size_t of) const {
    const std::size_t a = node(scene_.joints[joint].a);
    return a == of ? node(scene_.joints[joint].b) : a;
  }

  // Depth first, without recursion: a chain may be long.
  void visit_from(std::size_t start) {
    const std::size_t none = scene_.joints.size();
    std::vector<Visit> path = {{start, none, 0}};
    number_[start] = lowest_[start] = ++count_;
    while (!path.empty()) {
      Visit& at = path.back();
      if (at.next_edge < edges_[at.node].size()) {
        const std::size_t joint = edges_[at.node][at.next_edge++], other = other_end(joint, at.node);
        if (joint == at.by_joint) continue;
        if (number_[other] != 0) {
          on_loop_[joint] = true;  // it leads back
          lowest_[at.node] = std::min(lowest_[at.node], number_[other]);
          continue;
        }
        number_[other] = lowest_[other] = ++count_;
        path.push_back({other, joint, 0});
        continue;
      }
      const Visit done = at;
      path.pop_back();
      if (path.empty()) return;
      lowest_[path.back().node] = std::min(lowest_[path.back().node], lowest_[done.node]);
      if (lowest_[done.node] <= number_[path.back().node]) on_loop_[done.by_joint] = true;
    }
  }

  const Scene& scene_;
  std::vector<std::vector<std::size_t>> edges_;  // joints, by node
  std::vector<bool> on_loop_;
  std::vector<int> number_, lowest_;  // in the order of visits; the lowest reached from below
  int count_ = 0;
};

}  // namespace

std::vector<bool> joints_on_loops(const Scene& scene) { return Bridges(scene).joints_on_loops(); }

}  // namespace rigor::inline scene
