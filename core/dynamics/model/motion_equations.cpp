#include "core/dynamics/model/motion_equations.h"

#include <algorithm>

namespace rigor::inline dynamics {

MotionEquations::MotionEquations(const System& system, ConstraintForces* constraints)
    : system_(system),
      constraints_(constraints),
      loads_(system),
      stage_(system.size()),
      carried_(kCarriedColumns, system.size()) {}

void MotionEquations::keep_stages(std::size_t count) {
  rates_.assign(count, BodyTable(system_.size()));
  first_columns_.clear();
  for (const BodyTable& table : rates_) first_columns_.push_back(table.columns().column(0));
}

void MotionEquations::begin(BodyColumns state, BodyTable& y) {
  y = state;
  kernels().momentum_of(system_.constants.all(), state.column(0), carried_.data());
  for (int k = 0; k < 3; ++k)
    std::copy_n(carried_.column(kMomentum + k), system_.size(), y.columns().column(kAngularVelocity + k));
}

void MotionEquations::rates(const BodyTable& y, double t, double dt, BodyTable& out, ConstraintForces::Rows rows,
                            std::optional<double> instant) {
  double* const stage = stage_.columns().column(0);
  system_.constants.for_each_block(
      [&](const Bodies& block) { kernels().motion_of(block, y.columns().column(0), y.columns().stride(), stage); });
  const double* wrench = loads_.over_step(stage_.columns(), t, dt, instant);
  if (constraints_) wrench = constraints_->hold(stage_.columns(), wrench, rows);
  system_.constants.for_each_block(
      [&](const Bodies& block) { kernels().rates_at(block, stage, wrench, out.columns().column(0)); });
}

void MotionEquations::write(const BodyTable& y, MutableBodyColumns state) const {
  kernels().motion_of(system_.constants.all(), y.columns().column(0), y.columns().stride(), state.column(0));
}

void MotionEquations::combine(const BodyTable* y, double h, std::span<const double> weights, BodyTable& out) const {
  system_.constants.for_each_block([&](const Bodies& block) {
    kernels().combine(block, y ? y->columns().column(0) : nullptr, h, weights.data(), first_columns_.data(),
                      weights.size(), out.columns().column(0));
  });
}

double MotionEquations::relative_size(const BodyTable& change, const BodyTable& y) const {
  return kernels().relative_size(system_.constants.all(), change.columns().column(0), y.columns().column(0));
}

}  // namespace rigor::inline dynamics
