#include "core/base/factors.h"

namespace rigor {
namespace {

template <typename Factors>
Factors& kept_or_new(auto& factors) {
  if (auto* kept = std::get_if<Factors>(&factors)) return *kept;
  return factors.template emplace<Factors>();
}

bool has_no_zero_pivot(const auto& factors) {
  return factors.info() == Eigen::Success && factors.vectorD().cwiseAbs().minCoeff() > 0;
}

}  // namespace

void DenseFactors::factorise(const Eigen::MatrixXd& A, Kind kind) {
  if (kind == Kind::general) {
    kept_or_new<Eigen::PartialPivLU<Eigen::MatrixXd>>(factors_).compute(A);
  } else {
    kept_or_new<Eigen::LLT<Eigen::MatrixXd>>(factors_).compute(A);
  }
}

Eigen::VectorXd DenseFactors::solve(const Eigen::VectorXd& right_side) const {
  return std::visit([&](const auto& factors) -> Eigen::VectorXd { return factors.solve(right_side); }, factors_);
}

SymmetricFactors::SymmetricFactors(const Eigen::MatrixXd& A) : factors_(A) {}

bool SymmetricFactors::is_regular() const { return has_no_zero_pivot(factors_); }

Eigen::VectorXd SymmetricFactors::solve(const Eigen::VectorXd& right_side) const { return factors_.solve(right_side); }

SparseFactors::SparseFactors(const Eigen::SparseMatrix<double>& A) : factors_(A) {}

bool SparseFactors::is_regular() const { return has_no_zero_pivot(factors_); }

Eigen::VectorXd SparseFactors::solve(const Eigen::VectorXd& right_side) const { return factors_.solve(right_side); }

}  // namespace rigor
