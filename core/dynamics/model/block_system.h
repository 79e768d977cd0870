// A linear system whose unknowns are six numbers a body, given block by block and solved directly: dense while it is
// small, sparse where there are many bodies of which each meets few others.
#pragma once

#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <utility>
#include <vector>

#include "core/dynamics/model/load_jacobian.h"

namespace rigor {

class BlockSystem {
 public:
  explicit BlockSystem(std::size_t bodies);
  void clear();
  void add(std::size_t row, std::size_t column, const Mat6& block);
  // False if the matrix is singular, or so nearly that no digit of a solution would be right.
  bool solve(const Eigen::VectorXd& right_side, Eigen::VectorXd& solution);

 private:
  bool is_dense() const;
  bool factorise_sparse();

  Eigen::Index size_;
  Eigen::MatrixXd dense_;
  Eigen::PartialPivLU<Eigen::MatrixXd> dense_lu_;  // kept, so that its space is
  std::vector<Eigen::Triplet<double>> triplets_;
  std::vector<std::pair<std::size_t, std::size_t>> blocks_, ordered_blocks_;  // now, and when the unknowns were ordered
  Eigen::SparseMatrix<double> sparse_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> sparse_lu_;
};

}  // namespace rigor
