// Islands: bodies connected by contact points and joints through bodies that move. A permanently fixed body connects
// nothing. Each island's forces are solved alone, so the cost grows linearly with the islands and not with the cube of
// their number.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "core/dynamics/joints/joints.h"

namespace rigor::inline dynamics {

struct Island {
  std::vector<int> bodies;          // that move, in the order in which the points name them
  std::vector<std::size_t> points;  // ascending
};

// Islands of points between the bodies a and b of each pair, or the world; one of the two moves. They are in the order
// of their first points. `joints` may be null.
std::vector<Island> islands_of(const System& system, const std::vector<std::pair<int, int>>& pairs,
                               const Joints* joints = nullptr);

}  // namespace rigor::inline dynamics
