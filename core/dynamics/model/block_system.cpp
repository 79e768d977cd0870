#include "core/dynamics/model/block_system.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace rigor::inline dynamics {
namespace {

// Above this value of Skeel's condition number max_i (|A| |A⁻¹| |r|)_i / |r|_i no digit of a solution is left.
// Factorising a singular matrix does not fail, because rounding replaces its last zero pivot. The number is invariant
// under scaling of rows or columns, so masses and stiffnesses may differ arbitrarily.
constexpr double kSingular = 1e-2 / std::numeric_limits<double>::epsilon();

// Whether A is singular up to rounding, tested with one more right side. The right side is as large as A's rows, and
// has no direction that a system of bodies could have.
bool is_singular(const auto& A, const auto& lu) {
  const auto magnitudes = A.cwiseAbs();
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(A.cols());
  const Eigen::VectorXd rows = magnitudes * ones;
  if (!(rows.minCoeff() > 0)) return true;
  Eigen::VectorXd probe = rows;
  for (Eigen::Index i = 0; i < probe.size(); ++i) {
    probe[i] *= 1.5 + portable::sin(static_cast<double>(i * i + 1));  // from 0.5 to 2.5
  }
  const Eigen::VectorXd answer = lu.solve(probe);
  if (!answer.allFinite()) return true;
  const Eigen::VectorXd spread = magnitudes * answer.cwiseAbs();
  return spread.cwiseQuotient(probe).maxCoeff() > kSingular;
}

bool solve_by(const auto& A, const auto& lu, const Eigen::VectorXd& right_side, Eigen::VectorXd& solution) {
  if (is_singular(A, lu)) return false;
  solution = lu.solve(right_side);
  return solution.allFinite();
}

// Up to ten bodies a dense factorisation takes less time than a sparse one.
constexpr std::size_t kMostDense = 10;

}  // namespace

// The order of elimination depends only on the structure of the blocks, not on their values. It is found once.
struct BlockSystem::Sparse {
  using Blocks = std::vector<std::pair<std::size_t, std::size_t>>;

  explicit Sparse(std::size_t bodies, Kind of_kind) : kind(of_kind), matrix(size_of(bodies), size_of(bodies)) {}

  static Eigen::Index size_of(std::size_t bodies) { return 6 * static_cast<Eigen::Index>(bodies); }

  bool factorise_by(auto& factors, Blocks& ordered) {
    if (blocks != ordered) factors.analyzePattern(matrix), ordered = blocks;
    factors.factorize(matrix);
    return factors.info() == Eigen::Success;
  }

  bool solve(const Eigen::VectorXd& right_side, Eigen::VectorXd& solution) {
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    if (kind == Kind::symmetric && factorise_by(cholesky, ordered_by_cholesky))
      return solve_by(matrix, cholesky, right_side, solution);
    return factorise_by(lu, ordered_by_lu) && solve_by(matrix, lu, right_side, solution);
  }

  Kind kind;
  std::vector<Eigen::Triplet<double>> triplets;
  Eigen::SparseMatrix<double> matrix;
  Blocks blocks, ordered_by_cholesky, ordered_by_lu;           // now, and when the unknowns were ordered
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky;  // reports a matrix that is not positive definite
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu;
};

BlockSystem::BlockSystem(std::size_t bodies, Kind kind)
    : sparse_(bodies > kMostDense ? std::make_unique<Sparse>(bodies, kind) : nullptr) {
  if (is_dense()) dense_.resize(Sparse::size_of(bodies), Sparse::size_of(bodies));
}

BlockSystem::~BlockSystem() = default;

void BlockSystem::clear() {
  dense_.setZero();
  if (is_dense()) return;
  sparse_->triplets.clear();
  sparse_->blocks.clear();
}

void BlockSystem::add(std::size_t row, std::size_t column, const Mat6& block) {
  const Eigen::Index r = Sparse::size_of(row), c = Sparse::size_of(column);
  if (is_dense()) {
    dense_.block<6, 6>(r, c) += block;
    return;
  }
  sparse_->blocks.emplace_back(row, column);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j)
      sparse_->triplets.emplace_back(static_cast<int>(r + i), static_cast<int>(c + j), block(i, j));
  }
}

bool BlockSystem::solve(const Eigen::VectorXd& right_side, Eigen::VectorXd& solution) {
  if (!is_dense()) return sparse_->solve(right_side, solution);
  dense_lu_.factorise(dense_, DenseFactors::Kind::general);
  return solve_by(dense_, dense_lu_, right_side, solution);
}

}  // namespace rigor::inline dynamics
