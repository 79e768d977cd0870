// The order in which a symmetric matrix of blocks, one block row a joint, is eliminated: which joints meet, because
// they share a body, does not change, so that the order (least degree first: a chain or tree of joints fills in nothing
// but what its bodies' joints share) and the places of all products are found once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace rigor {

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
  // Where the product of each two blocks of a column goes, in order: to a block, or to ~position's diagonal.
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

}  // namespace rigor
