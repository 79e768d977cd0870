// Which of many boxes along W's axes overlap, in time that grows as N: a box stands in that cell of a cubic grid which
// holds its low corner, of several grids, each twice as wide as the one before, in the first whose cells are no smaller
// than the box; what overlaps it stands, in each grid, in the cells that it covers or in their lower neighbours. What
// is unbounded, as a plane, is tried against all.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/thread_pool.h"
#include "core/dynamics/collision/colliders.h"

namespace rigor {

class BroadPhase {
 public:
  // Each pair (first < second by their place in `boxes`) that overlaps, in ascending order. Boxes that are not finite
  // are tried against all.
  const std::vector<std::pair<int, int>>& overlaps(const std::vector<Aabb>& boxes);
  // Likewise, where since the last call only the boxes at these places are not the same: a search for these alone,
  // which threads may share.
  const std::vector<std::pair<int, int>>& overlaps(const std::vector<Aabb>& boxes, const std::vector<int>& changed,
                                                   ThreadPool* threads = nullptr);

 private:
  static constexpr int kGrids = 32;
  struct Entry {
    std::uint64_t cell;
    int box;
  };
  void choose_width(const std::vector<Aabb>& boxes);
  int grid_of(const Aabb& box) const;
  std::size_t bucket_of(std::uint64_t cell) const;
  void enter(const std::vector<Aabb>& boxes);
  using Pairs = std::vector<std::pair<int, int>>;
  void try_pair(int place, int other, const std::vector<Aabb>& boxes, Pairs& found) const;
  void search_all(int place, const std::vector<Aabb>& boxes, Pairs& found) const;
  void search_grid(int grid, int place, const std::vector<Aabb>& boxes, Pairs& found) const;
  void search_grids(int place, const std::vector<Aabb>& boxes, Pairs& found) const;
  void pairs_with_unbounded(const std::vector<Aabb>& boxes, Pairs& found) const;
  void sort_pairs();

  std::vector<int> all_;                 // places
  std::vector<char> is_changed_;         // by place
  std::vector<double> sizes_;            // m, of some boxes
  std::array<double, kGrids> widths_{};  // m, of the grids' cells
  std::array<std::size_t, kGrids> boxes_of_grid_{};
  std::vector<int> grid_;                 // by place, -1 for unbounded
  std::vector<std::uint64_t> cells_;      // by place
  int bits_ = 0;                          // of the number of a bucket
  std::vector<std::size_t> first_entry_;  // by bucket
  std::vector<Entry> entries_;            // bucket by bucket
  std::vector<int> unbounded_;            // places, ascending
  std::vector<std::size_t> first_pair_;   // by place of the first of both
  std::vector<Pairs> found_;              // by thread
  Pairs pairs_, kept_, sorted_;
};

}  // namespace rigor
