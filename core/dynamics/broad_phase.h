// Finds which of many balls may overlap, in time that grows as N log N: balls are sorted by the cell of a cubic grid
// that holds their centre, and only neighbouring cells are searched.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/math.h"

namespace rigor {

struct Ball {
  int body;       // whose it is
  Vec3 centre;    // m, in W
  double radius;  // m
};

class BroadPhase {
 public:
  // Each pair (first < second by their place in `balls`) whose balls overlap, in ascending order.
  const std::vector<std::pair<int, int>>& overlaps(const std::vector<Ball>& balls);

 private:
  struct Entry {
    std::uint64_t cell;
    int ball;
  };
  void search_cell(const std::vector<Ball>& balls, int ball, std::uint64_t cell);

  std::vector<Entry> entries_;
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace rigor
