// A symmetric composition of the symmetric map of second order
//   S(h) = kick over h/2, free drift over h, kick over h/2      (symmetric_kick.h, free_rotation.h):
// S(g_1 dt) S(g_2 dt) ... S(g_s dt) with g_i = g_(s+1-i). The weights g determine the order, also with dampers, because
// they only need S to be symmetric (Hairer, Lubich, Wanner, Geometric Numerical Integration, V.3). Without dampers S
// and the whole step are symplectic. A timed force that begins or ends inside a step divides the step.
#pragma once

#include <span>

#include "core/dynamics/integrators/constrained_drift.h"
#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/integrators/symmetric_kick.h"

namespace rigor::inline dynamics {

class LeapfrogComposition : public Stepper {
 public:
  // The weights must outlive the stepper.
  LeapfrogComposition(const StepperParts& parts, std::span<const double> weights);
  void step(MutableBodyColumns state, double t, double dt) override;
  std::string solver_warning() const override { return solver_warning_; }
  void archive_state(StateArchive& archive) override;

 private:
  void free_step(MutableBodyColumns state, double dt);
  void smooth_part(MutableBodyColumns state, double t, double dt);
  void kick(MutableBodyColumns state, double h, double t, double dt, double instant);

  StepperParts parts_;
  std::span<const double> weights_;
  SymmetricKick kick_;
  ConstrainedDrift drift_;
  Wrenches wrenches_;
  std::string solver_warning_;
};

}  // namespace rigor::inline dynamics
