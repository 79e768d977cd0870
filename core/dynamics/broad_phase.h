// Finds which of many balls may overlap, in time that grows as N log N: balls are sorted by the cell of a grid that
// holds their centre, and only neighbouring cells are searched. The search looks further than the balls reach, by what
// they move in some tens of steps along each axis, and holds until one has moved so far: most steps only look through
// the pairs it found. What comes out depends on the balls alone.
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
  // Each pair (first < second by their place in `balls`) whose balls overlap, in ascending order. Meant to be called
  // once a step with the same balls as they move; different balls only cost a search.
  const std::vector<std::pair<int, int>>& overlaps(const std::vector<Ball>& balls);

 private:
  struct Entry {
    std::uint64_t cell;
    int ball;
  };
  bool still_holds(const std::vector<Ball>& balls) const;
  void choose_slack(const std::vector<Ball>& balls);
  void search(const std::vector<Ball>& balls);
  void search_cell(const std::vector<Ball>& balls, int ball, std::uint64_t cell);
  bool may_meet(const Ball& a, const Ball& b) const;

  std::vector<Ball> found_at_;  // the balls when they were searched
  Vec3 slack_ = Vec3::Zero();   // m: how far a ball may have moved from there along each axis
  double steps_to_hold_ = 32;   // for which the slack is chosen
  int steps_held_ = 0;
  std::vector<Entry> entries_;
  std::vector<std::pair<int, int>> near_, pairs_;  // that may meet while the search holds; that overlap
};

}  // namespace rigor
