// Rows J of constraints on bodies that have N velocities each, and the multipliers that keep them, for any number type:
// S lambda = r with S = J M^-1 J^T, sparse, by LDL^T. Rows that depend on others (the loops of a plane mechanism) are
// left out: which, a rank-revealing QR decomposition of the rows, weighed by mass, says. How many is decided once,
// where the motion begins, for beside the manifold dependent rows look independent; which, anew where those in use have
// come to depend on each other. What is left out holds by itself, as long as it does depend on the rest.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace rigor {

enum class Residual { gap, rate };

// Onto a state's constraints by `correct`, a round that takes the residuals of all rows away to first order and returns
// how far it moved, or nothing if it cannot: positions by Newton's rounds, each of which squares what is left, until
// that is below rounding; then velocities, which are linear.
template <typename Real, typename Correct>
bool project_by(const Correct& correct) {
  constexpr int kMostRounds = 4;
  constexpr double kEnough = 1e-2 * std::numeric_limits<Real>::epsilon();
  for (int round = 0; round < kMostRounds; ++round) {
    const std::optional<double> moved = correct(Residual::gap);
    if (!moved) return false;
    if (*moved * *moved < kEnough) break;
  }
  return correct(Residual::rate).has_value();
}

template <typename Real, int N>
struct ConstraintRow {
  using Block = Eigen::Matrix<Real, N, 1>;
  int body[2] = {-1, -1};                           // moving bodies, or -1
  Block block[2] = {Block::Zero(), Block::Zero()};  // d(rate)/d(velocities of that body)
  Real bias = 0;                                    // the second derivative is sum of block * acceleration, and this
  Real gap = 0;                                     // what has to be zero
  Real speed = 0;                                   // what the rate has to be

  Real rate(const std::vector<Block>& velocities) const {
    Real sum = 0;
    for (int k = 0; k < 2; ++k) {
      if (body[k] >= 0) sum += block[k].dot(velocities[body[k]]);
    }
    return sum;
  }
  Real residual(Residual what, const std::vector<Block>& velocities) const {
    return what == Residual::gap ? gap : Real(rate(velocities) - speed);
  }
};

// Which rows are in use.
struct RowChoice {
  static RowChoice all(int rows) {
    RowChoice choice{rows, std::vector<int>(rows)};
    std::iota(choice.chosen.begin(), choice.chosen.end(), 0);
    return choice;
  }

  int rank = -1;            // not known yet
  std::vector<int> chosen;  // ascending
  double condition = 0;     // of S when they were chosen: its smallest pivot beside its largest
};

template <typename Real, int N>
class ConstraintRows {
 public:
  explicit ConstraintRows(RowChoice choice = {}) : choice_(std::move(choice)) {}
  const RowChoice& choice() const { return choice_; }
  // Forgets that other rows have come into use since the choice was made; keeps what does not hang on it.
  void restart(const RowChoice& choice) {
    is_laid_out_ = is_laid_out_ && choice.chosen == choice_.chosen;
    choice_ = choice;
  }

  using Row = ConstraintRow<Real, N>;
  using Block = typename Row::Block;
  using InverseMass = Eigen::Matrix<Real, N, N>;
  using Multipliers = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  // False where the rows in use are as good as dependent: a singular position.
  bool factorise(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass) {
    if (choice_.rank < 0 && !select(rows, inverse_mass)) return false;
    if (!is_laid_out_) lay_out(rows, inverse_mass.size());
    const bool is_regular = decompose(rows, inverse_mass);
    constexpr double kWorse = 1e-3;  // than where they were chosen
    if (static_cast<int>(rows.size()) == choice_.rank) return is_regular;
    if (is_regular && condition() > kWorse * choice_.condition) return true;
    return select(rows, inverse_mass);
  }

  // M^-1 J^T lambda for each body, with S lambda = -residual: what takes the residual of each row away.
  template <typename Residual>
  std::vector<Block> correction(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass,
                                const Residual& residual) const {
    Multipliers right(choice_.rank);
    for (int i = 0; i < choice_.rank; ++i) right[i] = -residual(rows[pivots_[i]]);
    if (choice_.rank > 0) right = ldlt_.solve(right).eval();
    multipliers_.setZero(static_cast<Eigen::Index>(rows.size()));
    std::vector<Block> pushes(inverse_mass.size(), Block::Zero());
    for (int i = 0; i < choice_.rank; ++i) {
      const Row& row = rows[pivots_[i]];
      multipliers_[pivots_[i]] = right[i];
      for (int k = 0; k < 2; ++k) {
        if (row.body[k] >= 0) pushes[row.body[k]] += right[i] * row.block[k];
      }
    }
    for (std::size_t b = 0; b < pushes.size(); ++b) pushes[b] = inverse_mass[b] * pushes[b];
    return pushes;
  }
  // Whether no row in use comes near to repeating others: far from what roundings make of those that do.
  bool is_well_posed() const { return condition() > 1e-10; }
  // Of the last correction, by row: zero where it is left out.
  const Multipliers& multipliers() const { return multipliers_; }

 private:
  using Matrix = Eigen::SparseMatrix<Real>;
  // S(i, j) sums, over the bodies that rows i and j share, block_i . M^-1 block_j.
  struct Term {
    int i, j, end_i, end_j, place;
  };

  bool select(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass) {
    Eigen::MatrixXd weighed = Eigen::MatrixXd::Zero(N * inverse_mass.size(), rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (int k = 0; k < 2; ++k) {
        const int b = rows[r].body[k];
        if (b < 0) continue;
        const Eigen::Matrix<double, N, N> root = inverse_mass[b].template cast<double>().llt().matrixL();
        weighed.col(r).segment(N * b, N) = root.transpose() * rows[r].block[k].template cast<double>();
      }
      if (const double length = weighed.col(r).norm(); length > 0) weighed.col(r) /= length;
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(weighed);
    constexpr double kDependent = 1e-9;  // beside the largest: on the manifold, to a double's roundings, it is zero
    qr.setThreshold(kDependent);
    if (choice_.rank < 0) choice_.rank = static_cast<int>(qr.rank());
    if (qr.rank() < choice_.rank) return false;
    const int* order = qr.colsPermutation().indices().data();
    choice_.chosen.assign(order, order + choice_.rank);
    std::sort(choice_.chosen.begin(), choice_.chosen.end());
    lay_out(rows, inverse_mass.size());
    if (!decompose(rows, inverse_mass)) return false;
    choice_.condition = condition();
    return true;
  }

  // The rows in use in the order in which they are eliminated, and where in S each of their products goes.
  void lay_out(const std::vector<Row>& rows, std::size_t bodies) {
    pivots_ = choice_.chosen;
    is_laid_out_ = true;
    if (choice_.rank == 0) return;
    place_terms(rows, bodies);
    const Matrix whole = matrix_.template selfadjointView<Eigen::Upper>();
    Eigen::PermutationMatrix<Eigen::Dynamic> order;
    Eigen::AMDOrdering<int>()(whole, order);
    for (int i = 0; i < choice_.rank; ++i) pivots_[i] = choice_.chosen[order.indices()[i]];
    place_terms(rows, bodies);
    ldlt_.analyzePattern(matrix_);
  }

  void place_terms(const std::vector<Row>& rows, std::size_t bodies) {
    std::vector<std::vector<std::pair<int, int>>> at(bodies);  // pivot and end
    for (int i = 0; i < choice_.rank; ++i) {
      for (int k = 0; k < 2; ++k) {
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

  bool decompose(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass) {
    if (choice_.rank == 0) return true;
    weighed_.resize(choice_.rank);
    for (int i = 0; i < choice_.rank; ++i) {
      const Row& row = rows[pivots_[i]];
      for (int k = 0; k < 2; ++k) {
        if (row.body[k] >= 0) weighed_[i][k].noalias() = inverse_mass[row.body[k]] * row.block[k];
      }
    }
    std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), Real(0));
    for (const Term& term : terms_) {
      matrix_.valuePtr()[term.place] += rows[pivots_[term.i]].block[term.end_i].dot(weighed_[term.j][term.end_j]);
    }
    ldlt_.factorize(matrix_);
    constexpr double kSingular = 1e-15;  // of a long double's 1e-19: no digit that counts would be left of a double's
    return ldlt_.info() == Eigen::Success && condition() > kSingular;
  }

  double condition() const {
    if (choice_.rank == 0) return 1;
    const auto& d = ldlt_.vectorD();
    return static_cast<double>(d.minCoeff()) / static_cast<double>(d.maxCoeff());
  }

  RowChoice choice_;
  bool is_laid_out_ = false;
  std::vector<int> pivots_;  // the rows in use
  std::vector<Term> terms_;
  Matrix matrix_;  // upper triangle, by pivots: as ldlt_ takes it without a copy
  std::vector<std::array<Block, 2>> weighed_;
  Eigen::SimplicialLDLT<Matrix, Eigen::Upper, Eigen::NaturalOrdering<int>> ldlt_;
  mutable Multipliers multipliers_;  // of the last correction
};

}  // namespace rigor
