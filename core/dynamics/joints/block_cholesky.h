// The factor S = L Lᵀ of a symmetric block matrix with one block row per joint. Two joints are coupled if they share a
// body. The structure never changes, so the order of elimination and the positions of all products are computed once.
// Eliminating least degree first causes no fill-in for chains and trees. A factorisation allocates nothing, and its
// time is linear in the number of joints of a chain.
//
// S may be singular because rows repeat others, as in closed loops of hinges. Each block has a rank that is fixed when
// the factor is made. choose() picks that many rows, those with the largest pivots, and leaves out the others. A fixed
// rank gives smooth results off the manifold of exact repetition; a threshold would not.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/dynamics/joints/constraint_rows.h"
#include "core/dynamics/joints/elimination_order.h"

namespace rigor::inline dynamics {

using Block6 = Eigen::Matrix<double, 6, 6>;
using Block = Eigen::Map<Eigen::MatrixXd>;  // without gaps between its columns

class BlockCholesky {
 public:
  // `rows` of each joint, at most six, and the pairs of joints that share a body, in any order, also more than once.
  BlockCholesky(std::vector<int> rows, const std::vector<std::pair<int, int>>& coupled);

  std::size_t size() const { return rows_.size(); }
  void clear();
  // Rows that a joint may have but has not now: identity there, and zero in the blocks beside. Ranks are to be found
  // anew after it.
  void set_rows_in_use(std::size_t joint, int rows) { in_use_[order_.position[joint]] = rows; }
  Block diagonal(std::size_t joint) { return {diagonal_of(order_.position[joint]), rows_[joint], rows_[joint]}; }
  EliminationOrder::Place place(int first, int second) const { return order_.place(first, second); }
  Block block(std::int32_t index) { return {block_at(index), block_rows_[index], block_columns_[index]}; }

  // Finds each block's rank from the filled S, on the manifold. A pivot counts as zero below kZero times the row's own
  // diagonal element. Rounding leaves 1e-11 of it if masses and inertias differ by 1e5. A true pivot as small as kZero
  // occurs only within 1e-4 rad of a singular position.
  void find_ranks();
  static constexpr double kZero = 1e-8;
  int rank() const;  // of all blocks together
  bool has_redundant_rows() const { return has_redundant_; }

  // A row's pivot below this share of its own diagonal element is lost in the rounding of the subtracted terms.
  static constexpr double kLost = 1e-13;

  // Factorises the filled S, which is overwritten. With `choose`, selects the rows again.
  void factorise(bool choose);
  // The smallest pivot of a kept row relative to its own diagonal element, and its joint. Near zero the joints are in a
  // singular position.
  double smallest_pivot() const { return smallest_pivot_; }
  std::size_t joint_of_smallest_pivot() const { return joint_of_smallest_; }
  // Solves S x = b in place; a row left out gets 0.
  void solve(std::vector<Vec6>& x) const { solve(x, 0, size()); }

  // Joints that are connected by bodies that can move make a component; its joints are eliminated one after another.
  // Numbered in the order of their first joints.
  int components() const { return order_.components; }
  int component_of(std::size_t joint) const { return order_.component[joint]; }
  // solve() for the joints of a component alone; the others' x is not read.
  void solve_component(int component, std::vector<Vec6>& x) const {
    solve(x, order_.first_of_component[component], order_.first_of_component[component + 1]);
  }

  // Which rows count, which later factorisations keep, and what is known of the last one.
  template <typename Archive>
  void archive_state(Archive& archive) {
    archive(in_use_, rank_, kept_, has_redundant_, smallest_pivot_, joint_of_smallest_);
  }

 private:
  void solve(std::vector<Vec6>& x, std::size_t first, std::size_t last) const;
  void lay_out();
  int rows_at(std::size_t p) const { return rows_[order_.joint[p]]; }
  double* diagonal_of(std::size_t p) { return values_.data() + diagonal_start_[p]; }
  const double* diagonal_of(std::size_t p) const { return values_.data() + diagonal_start_[p]; }
  double* block_at(std::int32_t index) { return values_.data() + block_start_[static_cast<std::size_t>(index)]; }
  const double* block_at(std::int32_t index) const {
    return values_.data() + block_start_[static_cast<std::size_t>(index)];
  }
  void note_scales();
  void eliminate(std::size_t p, bool choose, bool find_rank);
  void choose_rows(std::size_t p, bool find_rank);
  void leave_out_rows(std::size_t p);
  template <int R>
  void factorise_diagonal(std::size_t p);

  EliminationOrder order_;
  std::vector<int> rows_, in_use_, rank_;  // by joint; by position
  // Each column of blocks in one piece, in the order of elimination: its diagonal block, then those below.
  std::vector<double> values_;
  std::vector<std::size_t> diagonal_start_, block_start_;
  std::vector<Vec6> scale_, kept_;  // by position: the diagonal before elimination; 1 for a row that counts, or 0
  std::vector<int> block_rows_, block_columns_;  // as the order has them below the diagonal
  bool has_redundant_ = false;
  double smallest_pivot_ = 1;
  std::size_t joint_of_smallest_ = 0;
};

}  // namespace rigor::inline dynamics
