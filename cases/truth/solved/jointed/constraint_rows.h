// Rows J of constraints on bodies with N velocities each, and their multipliers, for any number type: S lambda = r with
// S = J M^-1 J^T, sparse, by LDL^T. Dependent rows (the loops of a plane mechanism) are left out; a rank-revealing QR
// decomposition of the rows, weighted by mass, selects them. The rank is decided once, at the start, because dependent
// rows look independent beside the manifold. The selection changes when the rows in use become dependent. A row that is
// left out is satisfied as long as it depends on the others.
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace rigor::inline truth {

enum class Residual { gap, rate };

// Projects a state onto its constraints. `correct` removes the residuals of all rows to first order and returns the
// size of its change, or nothing if it fails. Positions need several Newton iterations, each of which squares the rest,
// until it is below rounding. Velocities are linear and need one.
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
struct ReferenceRow {
  using Block = Eigen::Matrix<Real, N, 1>;
  static constexpr int kEnds = 4;      // a joint uses two of them
  int body[kEnds] = {-1, -1, -1, -1};  // moving bodies, or -1
  // d(rate)/d(velocities of that body)
  Block block[kEnds] = {Block::Zero(), Block::Zero(), Block::Zero(), Block::Zero()};
  Real bias = 0;        // the second derivative is sum of block * acceleration, and this
  Real gap = 0;         // the value that must be zero
  Real speed = 0;       // the required rate
  Real compliance = 0;  // of a row that forces alone obey: by how much the second derivative falls with the multiplier

  Real rate(const std::vector<Block>& velocities) const {
    Real sum = 0;
    for (int k = 0; k < kEnds; ++k) {
      if (body[k] >= 0) sum += block[k].dot(velocities[body[k]]);
    }
    return sum;
  }
  Real residual(Residual what, const std::vector<Block>& velocities) const {
    if (compliance > 0) return 0;
    return what == Residual::gap ? gap : Real(rate(velocities) - speed);
  }
};

// The rows in use.
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

// Compiled for double and long double, with N = 6 and 12.
template <typename Real, int N>
class ConstraintRows {
 public:
  explicit ConstraintRows(RowChoice choice = {}) : choice_(std::move(choice)) {}
  const RowChoice& choice() const { return choice_; }
  // Forgets that the selection has changed, and keeps the data that do not depend on it.
  void restart(const RowChoice& choice) {
    is_laid_out_ = is_laid_out_ && choice.chosen == choice_.chosen;
    choice_ = choice;
  }

  using Row = ReferenceRow<Real, N>;
  using Block = typename Row::Block;
  using InverseMass = Eigen::Matrix<Real, N, N>;
  using Multipliers = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  // False where the rows in use are as good as dependent: a singular position.
  bool factorise(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass);

  // M^-1 J^T lambda for each body, with S lambda = -residual: what takes the residual of each row away.
  template <typename Residual>
  std::vector<Block> correction(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass,
                                const Residual& residual) const {
    Multipliers right(choice_.rank);
    for (int i = 0; i < choice_.rank; ++i) right[i] = -residual(rows[pivots_[i]]);
    return pushes(rows, inverse_mass, std::move(right));
  }
  // Whether no row in use nearly repeats others: far above the level of rounding for repeated rows.
  bool is_well_posed() const { return condition() > 1e-10; }
  // The multipliers of the last correction, by row: zero for rows that are left out.
  const Multipliers& multipliers() const { return multipliers_; }

 private:
  using Matrix = Eigen::SparseMatrix<Real>;
  // S(i, j) sums, over the bodies that rows i and j share, block_i . M^-1 block_j.
  struct Term {
    int i, j, end_i, end_j, place;
  };

  bool select(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass);
  void lay_out(const std::vector<Row>& rows, std::size_t bodies);
  void place_terms(const std::vector<Row>& rows, std::size_t bodies);
  bool decompose(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass);
  // The change of each body, by S lambda = `right`.
  std::vector<Block> pushes(const std::vector<Row>& rows, const std::vector<InverseMass>& inverse_mass,
                            Multipliers right) const;
  double condition() const;

  RowChoice choice_;
  bool is_laid_out_ = false;
  std::vector<int> pivots_;  // the rows in use
  std::vector<Term> terms_;
  Matrix matrix_;  // upper triangle, by pivots: as ldlt_ takes it without a copy
  std::vector<std::array<Block, Row::kEnds>> weighed_;
  Eigen::SimplicialLDLT<Matrix, Eigen::Upper, Eigen::NaturalOrdering<int>> ldlt_;
  mutable Multipliers multipliers_;  // of the last correction
};

}  // namespace rigor::inline truth
