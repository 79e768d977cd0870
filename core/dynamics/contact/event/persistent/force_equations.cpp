#include "core/dynamics/contact/event/persistent/force_equations.h"

#include <utility>

namespace rigor::inline dynamics {
namespace {

// rho of a row, in units of its own effective mass. Each round leaves some 1/rho of an error and loses as many digits,
// which the next one recovers.
constexpr double kPenalty = 1e6;
constexpr int kMostForceRounds = 6;
constexpr double kSettled = 1e-15;  // of the accelerations without forces

}  // namespace

void ForceEquations::clear() {
  rows_.clear();
  is_symmetric_ = true;
}

void ForceEquations::add(Row row, bool has_P_of_J) {
  row.weight = kPenalty / row.square();
  is_symmetric_ = is_symmetric_ && has_P_of_J;
  rows_.push_back(std::move(row));
}

Eigen::VectorXd ForceEquations::accelerations_through_joints(Eigen::Index size) const {
  Eigen::VectorXd accelerations = Eigen::VectorXd::Zero(size);
  for (const Row& row : rows_) accelerations += row.multiplier * row.response;
  return accelerations;
}

// The accelerations that the rows still need.
double ForceEquations::find_residuals(const Eigen::VectorXd& free) {
  acceleration_ = free;
  for (const Row& row : rows_) {
    if (is_through_joints_) {
      acceleration_ += row.multiplier * row.response;
      continue;
    }
    for (const Side& side : row.side) {
      if (side.place >= 0) acceleration_.segment<6>(6 * side.place) += row.multiplier * side.of_P;
    }
  }
  residual_.resize(static_cast<Eigen::Index>(rows_.size()));
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    double r = -rows_[i].bias;
    for (const Side& side : rows_[i].side) {
      if (side.place >= 0) r -= side.of_J.dot(acceleration_.segment<6>(6 * side.place));
    }
    residual_[static_cast<Eigen::Index>(i)] = r;
  }
  return rows_.empty() ? 0 : residual_.cwiseAbs().maxCoeff();
}

// dl = rho (r - J dV'),   (M + Pᵀ rho J) dV' = Pᵀ rho r.
Eigen::VectorXd ForceEquations::change_through_accelerations(Eigen::Index size) const {
  Eigen::VectorXd right_side = Eigen::VectorXd::Zero(size), change(residual_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double weighed = rows_[i].weight * residual_[static_cast<Eigen::Index>(i)];
    for (const Side& side : rows_[i].side) {
      if (side.place >= 0) right_side.segment<6>(6 * side.place) += weighed * side.of_P;
    }
  }
  const Eigen::VectorXd by = factors_.solve(right_side);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    double r = residual_[static_cast<Eigen::Index>(i)];
    for (const Side& side : rows_[i].side) {
      if (side.place >= 0) r -= side.of_J.dot(by.segment<6>(6 * side.place));
    }
    change[static_cast<Eigen::Index>(i)] = rows_[i].weight * r;
  }
  return change;
}

void ForceEquations::assemble_in_accelerations(Eigen::Index size) {
  matrix_.setIdentity(size, size);
  for (const Row& row : rows_) {
    for (const Side& of : row.side) {
      for (const Side& by : row.side) {
        if (of.place >= 0 && by.place >= 0)
          matrix_.block<6, 6>(6 * of.place, 6 * by.place).noalias() +=
              (row.weight * of.of_P).lazyProduct(by.of_J.transpose());
      }
    }
  }
}

// What a unit of one row's force adds to the acceleration of another.
double ForceEquations::effect(const Row& of, const Row& by) const {
  double sum = 0;
  for (const Side& of_side : of.side) {
    if (of_side.place < 0) continue;
    if (is_through_joints_) {
      sum += of_side.of_J.dot(by.response.segment<6>(6 * of_side.place));
      continue;
    }
    for (const Side& by_side : by.side) {
      if (of_side.place == by_side.place) sum += of_side.of_J.dot(by_side.of_P);
    }
  }
  return sum;
}

void ForceEquations::assemble_in_forces() {
  const auto count = static_cast<Eigen::Index>(rows_.size());
  matrix_.setZero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    matrix_(i, i) = 1 / row.weight;
    for (Eigen::Index j = 0; j < count; ++j) matrix_(i, j) += effect(row, rows_[static_cast<std::size_t>(j)]);
  }
}

// In whichever there are fewer of; through joints in forces.
void ForceEquations::solve(const Eigen::VectorXd& free) {
  const bool in_forces = is_through_joints_ || static_cast<Eigen::Index>(rows_.size()) < free.size();
  in_forces ? assemble_in_forces() : assemble_in_accelerations(free.size());
  factors_.factorise(matrix_, is_symmetric_ ? DenseFactors::Kind::positive_definite : DenseFactors::Kind::general);
  double size = 0;
  for (int round = 0; round < kMostForceRounds; ++round) {
    const double largest = find_residuals(free);
    if (round == 0) size = largest;
    if (!(largest > kSettled * size)) break;
    const Eigen::VectorXd change = in_forces ? factors_.solve(residual_) : change_through_accelerations(free.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].multiplier += change[static_cast<Eigen::Index>(i)];
  }
}

}  // namespace rigor::inline dynamics
