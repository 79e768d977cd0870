// Boxes along W's axes in a tree with eight children per node, which are searched side by side. The boxes are in Morton
// order of their centres, so the children of a node lie near each other. When boxes move, the nodes are refitted. The
// order affects only the cost of a search and is renewed now and then.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/dynamics/collision/colliders.h"

namespace rigor::inline dynamics {

class BoxTree {
 public:
  // What a search needs; each thread that searches has its own.
  struct Scratch {
    std::vector<int> nodes, children;
  };

  // Updates the tree for these boxes. Only those at the given places have changed since the last call.
  void update(const std::vector<Aabb>& boxes, const std::vector<int>& changed);
  // Returns the places of the boxes that overlap `box`, in the tree's order. NaN overlaps all boxes. The result is
  // valid until the next search with this scratch.
  struct Places {
    const int* first;
    const int* last;
    const int* begin() const { return first; }
    const int* end() const { return last; }
  };
  Places overlapping(const Aabb& box, Scratch& scratch) const;

 private:
  static constexpr std::size_t kChildren = 8;
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // The boxes of the children, which are nodes of the level below, or in the lowest level the boxes themselves.
  struct alignas(64) Node {
    double low[3][kChildren], high[3][kChildren];  // m
  };
  void sort(const std::vector<Aabb>& boxes);
  void enter(const Aabb& box, std::size_t slot);
  void fit();
  static int* append_overlapping(const Node& node, const Aabb& box, Places children, int* out);

  std::vector<std::uint64_t> keys_;
  std::vector<int> order_;          // the place of the box in each slot
  std::vector<std::size_t> slots_;  // by place
  std::vector<std::vector<Node>> levels_;
  std::vector<int> numbers_;  // 0, 1, 2, …
  std::size_t changes_ = 0;   // since the order was renewed
};

}  // namespace rigor::inline dynamics
