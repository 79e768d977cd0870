#include "core/dynamics/contact/event/islands.h"

#include <numeric>

namespace rigor {

std::vector<Island> islands_of(const System& system, const std::vector<std::pair<int, int>>& pairs) {
  std::vector<int> parent(system.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root_of = [&](int body) {
    while (parent[body] != body) body = parent[body] = parent[parent[body]];
    return body;
  };
  for (const auto& [a, b] : pairs) {
    if (!system.bodies[a].fixed && !system.bodies[b].fixed) parent[root_of(a)] = root_of(b);
  }
  std::vector<Island> islands;
  std::vector<int> island_of(system.size(), -1);  // by root
  std::vector<bool> is_listed(system.size(), false);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [a, b] = pairs[i];
    int& island = island_of[root_of(system.bodies[a].fixed ? b : a)];
    if (island < 0) {
      island = static_cast<int>(islands.size());
      islands.emplace_back();
    }
    islands[island].points.push_back(i);
    for (const int body : {a, b}) {
      if (system.bodies[body].fixed || is_listed[body]) continue;
      is_listed[body] = true;
      islands[island].bodies.push_back(body);
    }
  }
  return islands;
}

}  // namespace rigor
