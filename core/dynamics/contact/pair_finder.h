// Which of many boxes along W's axes overlap, in time that grows as N log N: each box is entered in the cells of a
// cubic grid that it covers, entries are sorted by cell and along x, and the boxes of one cell are swept along x; a
// pair is told by the one cell that holds the low corner of the two boxes' overlap. Cells are as wide as twice the
// median box, and boxes far larger than that (a floor among bricks) are tried against all.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/dynamics/contact/colliders.h"

namespace rigor {

class PairFinder {
 public:
  // Each pair (first < second by their place in `boxes`) that overlaps, in ascending order. Boxes that are not finite
  // are tried against all.
  const std::vector<std::pair<int, int>>& overlaps(const std::vector<Aabb>& boxes);

 private:
  struct Entry {
    std::uint64_t cell;
    double low;  // m, of the box along x
    int box;
  };
  void enter_boxes(const std::vector<Aabb>& boxes);
  void pairs_of_cell(const std::vector<Aabb>& boxes, std::size_t first, std::size_t last);

  double width_ = 1;  // m, of a cell
  std::vector<double> sizes_;
  std::vector<Entry> entries_;
  std::vector<int> large_;
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace rigor
