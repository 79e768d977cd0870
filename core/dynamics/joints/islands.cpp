#include "core/dynamics/joints/islands.h"

#include <numeric>

namespace rigor::inline dynamics {

std::vector<Island> islands_of(const System& system, const std::vector<std::pair<int, int>>& pairs,
                               const Joints* joints) {
  const auto moves = [&](int body) { return body != kWorld && !system.bodies[body].fixed; };
  // A body with all that joints connect with it.
  const auto connected = [&](int body) {
    const int component = joints ? joints->component_of(body) : -1;
    return component < 0 ? std::vector<int>{body} : joints->bodies_of(component);
  };
  std::vector<int> parent(system.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root_of = [&](int body) {
    while (parent[body] != body) body = parent[body] = parent[parent[body]];
    return body;
  };
  for (const auto& [a, b] : pairs) {
    if (moves(a) && moves(b)) parent[root_of(a)] = root_of(b);
    for (const int body : {a, b}) {
      if (!joints || !moves(body)) continue;
      for (const int other : connected(body)) parent[root_of(other)] = root_of(body);
    }
  }
  std::vector<Island> islands;
  std::vector<int> island_of(system.size(), -1);  // by root
  std::vector<bool> is_listed(system.size(), false);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [a, b] = pairs[i];
    int& island = island_of[root_of(moves(a) ? a : b)];
    if (island < 0) {
      island = static_cast<int>(islands.size());
      islands.emplace_back();
    }
    islands[island].points.push_back(i);
    for (const int body : {a, b}) {
      if (!moves(body) || is_listed[body]) continue;
      for (const int other : connected(body)) {
        if (is_listed[other]) continue;
        is_listed[other] = true;
        islands[island].bodies.push_back(other);
      }
    }
  }
  return islands;
}

}  // namespace rigor::inline dynamics
