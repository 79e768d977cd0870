// Which of many boxes along W's axes overlap, in time that grows as N log N: each box is entered in the cells of a
// cubic grid that it covers, entries are sorted by cell and along x, and the boxes of one cell are swept along x; a
// pair is told by the one cell that holds the low corner of the two boxes' overlap. Cells are as wide as twice the
// median box, and boxes far larger than that (a floor among bricks) are tried against all.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/dynamics/collision/colliders.h"

namespace rigor {

class BroadPhase {
 public:
  // Each pair (first < second by their place in `boxes`) that overlaps, in ascending order. Boxes that are not finite
  // are tried against all.
  const std::vector<std::pair<int, int>>& overlaps(const std::vector<Aabb>& boxes);
  // Likewise, where since the last call only the boxes at these places are not the same: one pass over what is known,
  // and a search for these alone.
  const std::vector<std::pair<int, int>>& overlaps(const std::vector<Aabb>& boxes, const std::vector<int>& changed);

 private:
  struct Entry {
    std::uint64_t cell;
    double low;  // m, of the box along x
    int box;
    bool operator<(const Entry& other) const {
      return cell != other.cell ? cell < other.cell : low != other.low ? low < other.low : box < other.box;
    }
  };
  void choose_width(const std::vector<Aabb>& boxes);
  void forget_changed();
  void enter(const Aabb& box, int place);
  void pairs_of_cell(const std::vector<Aabb>& boxes, std::size_t first, std::size_t last);
  void pairs_with_large(const std::vector<Aabb>& boxes);

  double width_ = 1;              // m, of a cell
  std::vector<int> all_;          // places
  std::vector<char> is_changed_;  // by place
  std::vector<double> sizes_;     // m
  std::vector<Entry> entries_;    // in ascending order
  std::vector<int> large_;        // places
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace rigor
