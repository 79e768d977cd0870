// A linear system with six unknowns per body, given block by block and solved directly. Small systems are dense.
// Systems of many bodies with few couplings are sparse.
#pragma once

#include <memory>

#include "core/base/factors.h"
#include "core/dynamics/model/loads/load_jacobian.h"

namespace rigor::inline dynamics {

class BlockSystem {
 public:
  // symmetric: so is every matrix, block (i, j) the transpose of (j, i) but for roundings, and nearly always positive
  // definite. Many bodies are then solved by Cholesky's factors, which take a third of the time.
  enum class Kind { general, symmetric };
  explicit BlockSystem(std::size_t bodies, Kind kind = Kind::general);
  ~BlockSystem();
  void clear();
  void add(std::size_t row, std::size_t column, const Mat6& block);
  // False if the matrix is singular, or so nearly that no digit of a solution would be right.
  bool solve(const Eigen::VectorXd& right_side, Eigen::VectorXd& solution);

 private:
  struct Sparse;
  bool is_dense() const { return !sparse_; }

  Eigen::MatrixXd dense_;
  DenseFactors dense_lu_;
  std::unique_ptr<Sparse> sparse_;
};

}  // namespace rigor::inline dynamics
