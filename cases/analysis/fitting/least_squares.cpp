#include "cases/analysis/fitting/least_squares.h"

#include <algorithm>
#include <cmath>

#include "core/base/eigen_of.h"

namespace rigor::inline analysis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// A difference should move the residuals by a standard deviation. That is the distance over which an interval asks. In
// a much shorter one, contacts that open and close by turns would make the slope.
constexpr double kResidualMove = 1;
constexpr double kFirstBoxStep = 1e-3, kLeastBoxStep = 1e-9, kMostBoxStep = 0.05;  // values have twelve digits
constexpr double kFirstStep = 1, kLeastStep = 1e-6, kMostStep = 10;
constexpr double kLargestDamping = 1e4;
constexpr double kLongestStep = 30;  // of the unknowns outside the box, in standard deviations of the noise
// What is left to gain is taken off by the last step, which nobody evaluates. So this is the error of a linear model.
constexpr double kEnoughGain = 0.05;
constexpr double kWorthTaking = 1e-3;  // share of the predicted gain with which a step is taken

}  // namespace

LeastSquares::LeastSquares(ResidualsAt residuals, long boxed, long unknowns)
    : residuals_(std::move(residuals)), boxed_(boxed), unknowns_(unknowns), steps_(unknowns) {
  steps_.head(boxed).setConstant(kFirstBoxStep);
  steps_.tail(unknowns - boxed).setConstant(kFirstStep);
}

bool LeastSquares::evaluate(SquaresMinimum& point) const {
  point.residuals = residuals_({point.at}).front();
  point.value = point.has_result() && point.residuals.allFinite() ? point.residuals.squaredNorm() : HUGE_VAL;
  return std::isfinite(point.value);
}

void LeastSquares::differentiate(SquaresMinimum& point) {
  const long n = unknowns_;
  point.jacobian = Matrix::Zero(point.residuals.size(), n);
  std::vector<long> columns;
  for (long j = 0; j < n; ++j) columns.push_back(j);
  // Where a run has no result, the other side may have one.
  for (const double side : {1.0, -1.0}) {
    std::vector<Vector> points;
    Vector moves(n);
    for (const long j : columns) {
      const bool is_at_end = j < boxed_ && point.at[j] + steps_[j] > 1;
      moves[j] = (is_at_end ? -side : side) * steps_[j];
      points.push_back(point.at);
      points.back()[j] = j < boxed_ ? std::clamp(point.at[j] + moves[j], 0.0, 1.0) : point.at[j] + moves[j];
      moves[j] = points.back()[j] - point.at[j];
    }
    const std::vector<Vector> found = residuals_(points);
    std::vector<long> missing;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const long j = columns[k];
      if (found[k].size() == 0 || moves[j] == 0) {
        missing.push_back(j);
      } else {
        point.jacobian.col(j) = (found[k] - point.residuals) / moves[j];
      }
    }
    columns = missing;
    if (columns.empty()) break;
  }
  for (long j = 0; j < n; ++j) {
    const double wanted = kResidualMove / std::max(point.jacobian.col(j).norm(), 1e-300);
    steps_[j] =
        j < boxed_ ? std::clamp(wanted, kLeastBoxStep, kMostBoxStep) : std::clamp(wanted, kLeastStep, kMostStep);
  }
}

// Unknowns that would leave the box go to its face, and the others are solved for again.
Vector LeastSquares::step_of(const SquaresMinimum& from, double damping, long held) const {
  std::vector<long> free;
  for (long j = 0; j < unknowns_; ++j)
    if (j != held && from.jacobian.col(j).squaredNorm() > 0) free.push_back(j);
  Vector step = Vector::Zero(unknowns_), residuals = from.residuals;
  while (!free.empty()) {
    const long rows = residuals.size(), n = static_cast<long>(free.size());
    Matrix system = Matrix::Zero(rows + n, n);
    for (long k = 0; k < n; ++k) {
      const auto column = from.jacobian.col(free[static_cast<std::size_t>(k)]);
      system.col(k).head(rows) = column;
      system(rows + k, k) =
          std::sqrt(damping) * std::max(column.norm(), free[static_cast<std::size_t>(k)] < boxed_ ? 0 : 1.0);
    }
    Vector right = Vector::Zero(rows + n);
    right.head(rows) = -residuals;
    const Vector solved = rigor::least_squares(system, right);
    std::vector<long> still;
    for (long k = 0; k < n; ++k) {
      const long j = free[static_cast<std::size_t>(k)];
      const double to = from.at[j] + solved[k];
      step[j] = solved[k];
      if (j >= boxed_ || (to >= 0 && to <= 1)) {
        still.push_back(j);
        continue;
      }
      step[j] = (to < 0 ? 0 : 1) - from.at[j];
      residuals += step[j] * from.jacobian.col(j);
    }
    if (still.size() == free.size()) break;
    free = still;
  }
  // A start that the residuals hardly know must not run away: a body that rests forgets at what speed it was put down.
  const double longest = unknowns_ > boxed_ ? step.tail(unknowns_ - boxed_).lpNorm<Eigen::Infinity>() : 0;
  return longest > kLongestStep ? kLongestStep / longest * step : step;
}

SquaresMinimum LeastSquares::minimise(const Vector& start, long held, int most_steps) {
  SquaresMinimum best;
  best.at = start;
  if (!evaluate(best)) return best;
  differentiate(best);
  bool is_fresh = true;    // the Jacobian is that of the best point
  bool is_trusted = true;  // or it predicted the last gain well
  double damping = 1e-6;
  for (int n = 0; n < most_steps && damping < kLargestDamping; ++n) {
    const Vector step = step_of(best, damping, held);
    const double gain = best.value - (best.residuals + best.jacobian * step).squaredNorm();
    const double enough = kEnoughGain * std::max(1.0, best.value / static_cast<double>(best.residuals.size()));
    if (gain < enough && is_trusted) break;
    double share = 0;  // of the gain, that came true
    if (gain >= enough) {
      SquaresMinimum next;
      next.at = best.at + step, next.jacobian = best.jacobian;
      if (evaluate(next)) share = (best.value - next.value) / gain;
      if (share > kWorthTaking) best = std::move(next);
    }
    damping *= share > kWorthTaking ? 0.1 : is_fresh ? 10 : 1;
    damping = std::max(damping, share > kWorthTaking ? 1e-9 : 1e-5);
    if (share <= kWorthTaking && is_fresh) continue;
    is_trusted = share > 0.75 && share < 1.5, is_fresh = false;
    if (!is_trusted) differentiate(best), is_trusted = is_fresh = true;
  }
  // The rest of the way, as far as a straight line leads.
  const Vector step = step_of(best, 1e-9, held);
  best.at += step, best.residuals += best.jacobian * step;
  best.value = best.residuals.squaredNorm();
  return best;
}

}  // namespace rigor::inline analysis
