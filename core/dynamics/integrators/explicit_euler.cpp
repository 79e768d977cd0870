// Explicit Euler: every update uses the values at the start of the step.
//   x1 = x0 + dt v0,  R1 = R0 turned by dt w0,  v1 = v0 + dt F0/m,  w1 = w0 + dt I⁻¹(tau0 - w0 x I w0)
// On an undamped oscillation of frequency f [rad/s] each step multiplies the energy by 1 + (f dt)²: it always blows up.
#include "core/dynamics/integrators/euler_passes.h"
#include "core/dynamics/joints/joints.h"
#include "core/dynamics/model/wrench_columns.h"

namespace rigor::inline dynamics {
namespace {

class ExplicitEuler : public Stepper {
 public:
  explicit ExplicitEuler(const StepperParts& parts) : parts_(parts), passes_(parts), wrenches_(parts.system) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    const double* wrench = wrenches_.over_step(state, t, dt);
    if (ConstraintForces* forces = parts_.constraints())
      wrench = forces->hold(state, wrench, ConstraintForces::Rows::chosen_anew);
    parts_.system.constants.for_each_block(
        [&](const Bodies& block) { passes_.kick_and_drift_at_once(block, state, wrench, dt); });
    if (parts_.joints) parts_.joints->project(state);
    if (parts_.contact) parts_.contact->resolve(state);
  }

  void archive_state(StateArchive&) override {}  // nothing outlives a step

 private:
  StepperParts parts_;
  EulerPasses passes_;
  WrenchColumns wrenches_;
};

}  // namespace

extern const Integrator kExplicitEuler;
const Integrator kExplicitEuler = {
    .name = "explicit-euler",
    .summary = "positions and velocities from the start of the step; blows up on any oscillation",
    .order = 1,
    .symplectic = false,
    .leapfrog_stagger = -0.5,
    .default_orientation = "quaternion-exponential",
    .takes_joints = true,
    .holds_at_stages = true,
    .make = make_stepper<ExplicitEuler>,
};

}  // namespace rigor::inline dynamics
