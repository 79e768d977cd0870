// Islands: what is connected by contact points, and by joints, through bodies that move. A body at rest for good
// connects nothing, so that each island's forces can be found by themselves, at a cost that grows with the islands and
// not with their cube.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "core/dynamics/joints/joints.h"

namespace rigor {

struct Island {
  std::vector<int> bodies;          // that move, in the order in which the points name them
  std::vector<std::size_t> points;  // ascending
};

// Of points between the bodies a and b of each pair, or the world; one of the two moves. In the order of their first
// points. `joints` may be null.
std::vector<Island> islands_of(const System& system, const std::vector<std::pair<int, int>>& pairs,
                               const Joints* joints = nullptr);

}  // namespace rigor
