// The equations of motion as one first-order system y' = f(y), for Runge–Kutta methods that keep the rates of all their
// stages. y is a table of columns laid out as a body's motion, with the angular momentum L in W in place of w:
//   x' = v,  q' = (0, w) q / 2,  v' = F/m,  L' = tau,  with w from L and the orientation.
// Only the quaternion's direction counts.
#pragma once

#include <optional>
#include <span>

#include "core/dynamics/model/constraint_forces.h"
#include "core/dynamics/model/system.h"
#include "core/dynamics/model/wrench_columns.h"

namespace rigor::inline dynamics {

class MotionEquations {
 public:
  // `constraints` is null where nothing holds the bodies.
  explicit MotionEquations(const System& system, ConstraintForces* constraints = nullptr);

  // Reads y from `state`.
  void begin(BodyColumns state, BodyTable& y);
  // f(y), with the timed forces' mean over the step [t, t + dt]. For `rows` see ConstraintForces, for `instant`
  // JointDrive::effort().
  void rates(const BodyTable& y, double t, double dt, BodyTable& out,
             ConstraintForces::Rows rows = ConstraintForces::Rows::as_chosen, std::optional<double> instant = {});
  // Writes y to the state.
  void write(const BodyTable& y, MutableBodyColumns state) const;

  // out = y + h (weights[0] rates[0] + weights[1] rates[1] + …), or the sum alone where there is no y.
  void combine(const BodyTable* y, double h, std::span<const double> weights, BodyTable& out) const;
  // The weighted sum for combine(); stage s is rates_of_stage(s).
  BodyTable& rates_of_stage(std::size_t s) { return rates_[s]; }
  void keep_stages(std::size_t count);

  // The relative size of a change of y: the sum of |dx|/(1 m + |x|), |dv|/(1 m/s + |v|), |dw|/(1 rad/s + |w|) and the
  // angle [rad], largest over all bodies. dw is the change of w by the change of L.
  double relative_size(const BodyTable& change, const BodyTable& y) const;

 private:
  const System& system_;
  ConstraintForces* constraints_;
  WrenchColumns loads_;
  BodyTable stage_;
  Columns carried_;
  std::vector<BodyTable> rates_;
  std::vector<const double*> first_columns_;  // of rates_
};

}  // namespace rigor::inline dynamics
