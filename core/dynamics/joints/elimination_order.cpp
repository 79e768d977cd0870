#include "core/dynamics/joints/elimination_order.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <set>
#include <tuple>

namespace rigor::inline dynamics {

EliminationOrder::EliminationOrder(std::size_t joints, const std::vector<std::pair<int, int>>& coupled)
    : position(joints) {
  find_components(coupled);
  order(coupled);
  list_products();
}

void EliminationOrder::find_components(const std::vector<std::pair<int, int>>& coupled) {
  std::vector<std::vector<int>> neighbours(position.size());
  for (const auto& [a, b] : coupled) neighbours[a].push_back(b), neighbours[b].push_back(a);
  component.assign(neighbours.size(), -1);
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    if (component[k] >= 0) continue;
    component[k] = components;
    for (std::vector<int> todo = {static_cast<int>(k)}; !todo.empty();) {
      const int at = todo.back();
      todo.pop_back();
      for (const int next : neighbours[at]) {
        if (component[next] < 0) component[next] = components, todo.push_back(next);
      }
    }
    ++components;
  }
  first_of_component.assign(static_cast<std::size_t>(components) + 1, 0);
  for (const int of : component) ++first_of_component[static_cast<std::size_t>(of) + 1];
  std::partial_sum(first_of_component.begin(), first_of_component.end(), first_of_component.begin());
}

// Eliminates the joint with the fewest neighbours (the first of equals), component by component. Its neighbours then
// all become neighbours of each other. A chain is thus eliminated from one end to the other, so each joint has a body
// beside it that carries nothing yet. Elimination from both ends would leave the last joint between two heavy halves.
// With a thousand hinges its pivot relative to its own two bodies would then count as zero.
void EliminationOrder::order(const std::vector<std::pair<int, int>>& coupled) {
  std::vector<std::set<int>> neighbours(position.size());
  for (const auto& [a, b] : coupled) {
    if (a != b) neighbours[a].insert(b), neighbours[b].insert(a);
  }
  std::set<std::tuple<int, std::size_t, int>> queue;
  const auto entry = [&](int k) { return std::tuple(component[k], neighbours[k].size(), k); };
  for (std::size_t j = 0; j < neighbours.size(); ++j) queue.insert(entry(static_cast<int>(j)));
  std::vector<std::vector<int>> below(neighbours.size());
  while (!queue.empty()) {
    const int next = std::get<2>(*queue.begin());
    queue.erase(queue.begin());
    position[next] = joint.size();
    const std::vector<int> around(neighbours[next].begin(), neighbours[next].end());
    for (const int n : around) {
      queue.erase(entry(n));
      neighbours[n].erase(next);
      for (const int m : around) {
        if (m != n) neighbours[n].insert(m);
      }
      queue.insert(entry(n));
    }
    below[joint.size()] = around;
    joint.push_back(static_cast<std::size_t>(next));
  }
  for (std::size_t p = 0; p < size(); ++p) {
    first_below.push_back(static_cast<std::int32_t>(row_below.size()));
    for (const int k : below[p]) row_below.push_back(static_cast<std::int32_t>(position[k]));
    std::sort(row_below.begin() + first_below.back(), row_below.end());
  }
  first_below.push_back(static_cast<std::int32_t>(row_below.size()));
}

void EliminationOrder::list_products() {
  for (std::size_t p = 0; p < size(); ++p) {
    first_target.push_back(target.size());
    for (std::int32_t u = first_below[p]; u < first_below[p + 1]; ++u) {
      for (std::int32_t l = u; l < first_below[p + 1]; ++l) {
        const std::int32_t column = row_below[u], row = row_below[l];
        target.push_back(row == column ? ~column
                                       : place(static_cast<int>(joint[row]), static_cast<int>(joint[column])).index);
      }
    }
  }
}

EliminationOrder::Place EliminationOrder::place(int first, int second) const {
  std::size_t row = position[first], column = position[second];
  const bool transposed = row < column;
  if (transposed) std::swap(row, column);
  const auto begin = row_below.begin() + first_below[column], end = row_below.begin() + first_below[column + 1];
  const auto found = std::lower_bound(begin, end, static_cast<std::int32_t>(row));
  assert(found != end && *found == static_cast<std::int32_t>(row) &&
         "the joints share a body, or came to by filling in");
  return {static_cast<std::int32_t>(found - row_below.begin()), transposed};
}

}  // namespace rigor::inline dynamics
