// The order of elimination of a symmetric block matrix with one block row per joint. Joints are coupled if they share a
// body, and this never changes. The order and the positions of all products are therefore computed once. Least degree
// first causes no fill-in for chains and trees, except between joints that share a body.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace rigor::inline dynamics {

struct EliminationOrder {
  // The pairs of joints that share a body, in any order, also more than once.
  EliminationOrder(std::size_t joints, const std::vector<std::pair<int, int>>& coupled);

  std::size_t size() const { return joint.size(); }
  // The place of the block of two joints that share a body, and whether it is (second, first) that stands there.
  struct Place {
    std::int32_t index;
    bool transposed;
  };
  Place place(int first, int second) const;

  std::vector<std::size_t> joint;     // by position in the order of elimination
  std::vector<std::size_t> position;  // by joint
  // Blocks below the diagonal, column by column, rows ascending: the first of each position's, and each one's row.
  std::vector<std::int32_t> first_below, row_below;
  // The target of the product of each two blocks of a column, in order: a block, or the diagonal of ~position.
  std::vector<std::int32_t> target;
  std::vector<std::size_t> first_target;
  // Joints that are connected by bodies that can move make a component; its joints are eliminated one after another.
  // Numbered in the order of their first joints.
  int components = 0;
  std::vector<int> component;  // by joint
  std::vector<std::size_t> first_of_component;

 private:
  void find_components(const std::vector<std::pair<int, int>>& coupled);
  void order(const std::vector<std::pair<int, int>>& coupled);
  void list_products();
};

}  // namespace rigor::inline dynamics
