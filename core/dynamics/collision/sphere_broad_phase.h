// Finds which of many spheres may overlap, in time that grows as N log N: they are sorted by the cell of a grid that
// holds their centre, and only neighbouring cells are searched. The search looks further than the spheres reach, by
// what they move in many steps along each axis, and holds until one has moved so far: most steps only see that none
// has, and look through the pairs it found. What comes out depends on the spheres alone.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/dynamics/model/body_constants.h"
#include "core/engine/body_table.h"

namespace rigor {

struct Ball {
  int body;
  double radius;  // m
};

class SphereBroadPhase {
 public:
  explicit SphereBroadPhase(std::vector<Ball> balls);

  // Each pair (first < second by their place among the balls) that overlaps, in ascending order. Meant to be called
  // once a step. `spheres`: columns of SphereColumn, of which kFoundAt is kept here.
  const std::vector<std::pair<int, int>>& overlaps(const Bodies& bodies, BodyColumns state, Columns& spheres);

 private:
  struct Entry {
    std::uint64_t cell;
    int ball;
  };
  bool overlap(int a, int b, BodyColumns state) const;
  void choose_slack(BodyColumns state, const Columns& spheres);
  void search(BodyColumns state);
  void sort_by_cell(BodyColumns state);
  bool search_cells(BodyColumns state, std::uint64_t to_low, std::uint64_t to_high, bool own, std::size_t most);
  bool may_meet(int a, int b, BodyColumns state) const;

  std::vector<Ball> balls_;
  double largest_radius_ = 0;  // m
  Vec3 slack_ = Vec3::Zero();  // m: how far a ball may move along each axis while a search holds
  double steps_to_hold_ = 32;  // for which the slack is chosen
  int steps_held_ = 0;         // 0: nothing has been searched for
  std::vector<Entry> entries_;
  std::vector<std::pair<int, int>> near_, pairs_;  // that may meet while the search holds; that overlap
};

}  // namespace rigor
