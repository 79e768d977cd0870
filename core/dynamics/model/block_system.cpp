#include "core/dynamics/model/block_system.h"

#include <cmath>
#include <limits>

namespace rigor {
namespace {

// From what Skeel's condition number max_i (|A| |A⁻¹| |r|)_i / |r|_i leaves no digit of a solution: a factorisation of
// a singular matrix goes through all the same, for a rounding stands where its last pivot would be zero. Scaling a row
// or a column changes nothing, so that masses and stiffnesses may differ as they like.
constexpr double kSingular = 1e-2 / std::numeric_limits<double>::epsilon();

// Whether A is singular but for roundings, by one more right side: one as large as A's rows, and along no direction
// that a system of bodies could have for its own.
bool is_singular(const auto& A, const auto& lu) {
  const auto magnitudes = A.cwiseAbs();
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(A.cols());
  const Eigen::VectorXd rows = magnitudes * ones;
  if (!(rows.minCoeff() > 0)) return true;
  Eigen::VectorXd probe = rows;
  for (Eigen::Index i = 0; i < probe.size(); ++i) {
    probe[i] *= 1.5 + std::sin(static_cast<double>(i * i + 1));  // from 0.5 to 2.5
  }
  const Eigen::VectorXd answer = lu.solve(probe);
  if (!answer.allFinite()) return true;
  const Eigen::VectorXd spread = magnitudes * answer.cwiseAbs();
  return spread.cwiseQuotient(probe).maxCoeff() > kSingular;
}

}  // namespace

BlockSystem::BlockSystem(std::size_t bodies) : size_(6 * static_cast<Eigen::Index>(bodies)) {
  if (is_dense()) dense_.resize(size_, size_);
}

// Up to ten bodies a dense factorisation takes less time than a sparse one needs to order its unknowns.
bool BlockSystem::is_dense() const { return size_ <= 60; }

void BlockSystem::clear() {
  dense_.setZero();
  triplets_.clear();
  blocks_.clear();
}

void BlockSystem::add(std::size_t row, std::size_t column, const Mat6& block) {
  const Eigen::Index r = 6 * static_cast<Eigen::Index>(row), c = 6 * static_cast<Eigen::Index>(column);
  if (is_dense()) {
    dense_.block<6, 6>(r, c) += block;
    return;
  }
  blocks_.emplace_back(row, column);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      triplets_.emplace_back(static_cast<int>(r + i), static_cast<int>(c + j), block(i, j));
    }
  }
}

bool BlockSystem::solve(const Eigen::VectorXd& right_side, Eigen::VectorXd& solution) {
  if (is_dense()) {
    dense_lu_.compute(dense_);
    if (is_singular(dense_, dense_lu_)) return false;
    solution = dense_lu_.solve(right_side);
    return solution.allFinite();
  }
  if (!factorise_sparse() || is_singular(sparse_, sparse_lu_)) return false;
  solution = sparse_lu_.solve(right_side);
  return solution.allFinite();
}

// The order of elimination depends on which blocks there are, not on what is in them: it is found once.
bool BlockSystem::factorise_sparse() {
  sparse_.resize(size_, size_);
  sparse_.setFromTriplets(triplets_.begin(), triplets_.end());
  if (blocks_ != ordered_blocks_) {
    sparse_lu_.analyzePattern(sparse_);
    ordered_blocks_ = blocks_;
  }
  sparse_lu_.factorize(sparse_);
  return sparse_lu_.info() == Eigen::Success;
}

}  // namespace rigor
