// Boxes along W's axes in a tree whose nodes have eight children each, which are looked through side by side. Boxes
// stand in it in the order of a Morton curve through their centres, so that the children of a node lie near each other;
// as boxes move the nodes are made to fit again, and the order, of which only the cost of a search depends, is renewed
// now and then.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/dynamics/collision/colliders.h"

namespace rigor {

class BoxTree {
 public:
  // What a search needs; each thread that searches has its own.
  struct Scratch {
    std::vector<int> nodes, children;
  };

  // The tree of these boxes, of which since the last call only those at these places have changed.
  void update(const std::vector<Aabb>& boxes, const std::vector<int>& changed);
  // The places of the boxes that overlap `box`, in the tree's order; what is not a number overlaps all. They hold until
  // the next search with this scratch.
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

}  // namespace rigor
