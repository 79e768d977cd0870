#include "cases/truth/solved/jointed/constraint_rows.h"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/QR>
#include <algorithm>

namespace rigor::inline truth {
namespace {

struct IndependentColumns {
  int rank;
  std::vector<int> order;  // the first `rank` of them are independent
};

IndependentColumns independent_columns(const Eigen::MatrixXd& columns) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  constexpr double kDependent = 1e-9;  // beside the largest: on the manifold, to a double's roundings, it is zero
  qr.setThreshold(kDependent);
  const auto& order = qr.colsPermutation().indices();
  return {static_cast<int>(qr.rank()), std::vector<int>(order.data(), order.data() + order.size())};
}

// In which little fills in, of a symmetric matrix by its upper triangle.
std::vector<int> elimination_order(const Eigen::SparseMatrix<double>& upper) {
  const Eigen::SparseMatrix<double> whole = upper.selfadjointView<Eigen::Upper>();
  Eigen::PermutationMatrix<Eigen::Dynamic> order;
  Eigen::AMDOrdering<int>()(whole, order);
  return {order.indices().data(), order.indices().data() + order.size()};
}

}  // namespace

template <typename Real, int N>
bool ConstraintRows<Real, N>::factorise(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass) {
  if (choice_.rank < 0 && !select(rows, inverse_mass)) return false;
  if (!is_laid_out_) lay_out(rows, inverse_mass.size());
  const bool is_regular = decompose(rows, inverse_mass);
  constexpr double kWorse = 1e-3;  // than where they were chosen
  if (static_cast<int>(rows.size()) == choice_.rank) return is_regular;
  if (is_regular && condition() > kWorse * choice_.condition) return true;
  return select(rows, inverse_mass);
}

template <typename Real, int N>
bool ConstraintRows<Real, N>::select(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass) {
  const bool any_yields = std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.compliance > 0; });
  const std::size_t of_bodies = N * inverse_mass.size();
  Eigen::MatrixXd weighed = Eigen::MatrixXd::Zero(of_bodies + (any_yields ? rows.size() : 0), rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (int k = 0; k < Row::kEnds; ++k) {
      const int b = rows[r].body[k];
      if (b < 0) continue;
      const Eigen::Matrix<double, N, N> root = inverse_mass[b].template cast<double>().llt().matrixL();
      weighed.col(r).segment(N * b, N) = root.transpose() * rows[r].block[k].template cast<double>();
    }
    if (any_yields) weighed(of_bodies + r, r) = std::sqrt(static_cast<double>(rows[r].compliance));
    if (const double length = weighed.col(r).norm(); length > 0) weighed.col(r) /= length;
  }
  const auto [rank, order] = independent_columns(weighed);
  if (choice_.rank < 0) choice_.rank = rank;
  if (rank < choice_.rank) return false;
  choice_.chosen.assign(order.begin(), order.begin() + choice_.rank);
  std::sort(choice_.chosen.begin(), choice_.chosen.end());
  lay_out(rows, inverse_mass.size());
  if (!decompose(rows, inverse_mass)) return false;
  choice_.condition = condition();
  return true;
}

// The rows in use in the order in which they are eliminated, and where in S each of their products goes.
template <typename Real, int N>
void ConstraintRows<Real, N>::lay_out(const std::vector<Row>& rows, std::size_t bodies) {
  pivots_ = choice_.chosen;
  is_laid_out_ = true;
  if (choice_.rank == 0) return;
  place_terms(rows, bodies);
  const std::vector<int> order = elimination_order(matrix_.template cast<double>());
  for (int i = 0; i < choice_.rank; ++i) pivots_[i] = choice_.chosen[order[i]];
  place_terms(rows, bodies);
  ldlt_.analyzePattern(matrix_);
}

template <typename Real, int N>
void ConstraintRows<Real, N>::place_terms(const std::vector<Row>& rows, std::size_t bodies) {
  std::vector<std::vector<std::pair<int, int>>> at(bodies);  // pivot and end
  for (int i = 0; i < choice_.rank; ++i) {
    for (int k = 0; k < Row::kEnds; ++k) {
      if (const int b = rows[pivots_[i]].body[k]; b >= 0) at[b].emplace_back(i, k);
    }
  }
  std::vector<Eigen::Triplet<Real>> places;
  terms_.clear();
  for (const auto& here : at) {
    for (const auto& [i, end_i] : here) {
      for (const auto& [j, end_j] : here) {
        if (i > j) continue;
        places.emplace_back(i, j, Real(1));
        terms_.push_back({i, j, end_i, end_j, 0});
      }
    }
  }
  matrix_.resize(choice_.rank, choice_.rank);
  matrix_.setFromTriplets(places.begin(), places.end());
  matrix_.makeCompressed();
  for (Term& term : terms_) {
    const auto *begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[term.j],
               *end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[term.j + 1];
    term.place = static_cast<int>(std::lower_bound(begin, end, term.i) - matrix_.innerIndexPtr());
  }
}

template <typename Real, int N>
bool ConstraintRows<Real, N>::decompose(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass) {
  if (choice_.rank == 0) return true;
  weighed_.resize(choice_.rank);
  for (int i = 0; i < choice_.rank; ++i) {
    const Row& row = rows[pivots_[i]];
    for (int k = 0; k < Row::kEnds; ++k) {
      if (row.body[k] >= 0) weighed_[i][k].noalias() = inverse_mass[row.body[k]] * row.block[k];
    }
  }
  std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), Real(0));
  for (const Term& term : terms_) {
    matrix_.valuePtr()[term.place] += rows[pivots_[term.i]].block[term.end_i].dot(weighed_[term.j][term.end_j]);
  }
  for (int i = 0; i < choice_.rank; ++i)
    if (rows[pivots_[i]].compliance > 0) matrix_.coeffRef(i, i) += rows[pivots_[i]].compliance;
  ldlt_.factorize(matrix_);
  constexpr double kSingular = 1e-15;  // of a long double's 1e-19: no digit that counts would be left of a double's
  return ldlt_.info() == Eigen::Success && condition() > kSingular;
}

template <typename Real, int N>
auto ConstraintRows<Real, N>::pushes(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass,
                                     Multipliers right) const -> std::vector<Block> {
  if (choice_.rank > 0) right = ldlt_.solve(right).eval();
  multipliers_.setZero(static_cast<Eigen::Index>(rows.size()));
  std::vector<Block> pushes(inverse_mass.size(), Block::Zero());
  for (int i = 0; i < choice_.rank; ++i) {
    const Row& row = rows[pivots_[i]];
    multipliers_[pivots_[i]] = right[i];
    for (int k = 0; k < Row::kEnds; ++k) {
      if (row.body[k] >= 0) pushes[row.body[k]] += right[i] * row.block[k];
    }
  }
  for (std::size_t b = 0; b < pushes.size(); ++b) pushes[b] = inverse_mass[b] * pushes[b];
  return pushes;
}

template <typename Real, int N>
double ConstraintRows<Real, N>::condition() const {
  if (choice_.rank == 0) return 1;
  const auto& d = ldlt_.vectorD();
  return static_cast<double>(d.minCoeff()) / static_cast<double>(d.maxCoeff());
}

template class ConstraintRows<double, 6>;
template class ConstraintRows<double, 12>;
template class ConstraintRows<long double, 6>;
template class ConstraintRows<long double, 12>;

}  // namespace rigor::inline truth
