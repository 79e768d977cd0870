// The classical fourth-order Runge–Kutta method on (x, q, v, L):
//   x' = v,  q' = (0, w) q / 2,  v' = F/m,  L' = tau,  with w from L and q at every stage.
// The quaternion's length is not kept by the stages: rotations use its direction, and the step ends with a unit one.
#include "core/dynamics/integrators/classical_runge_kutta.h"

namespace rigor::inline dynamics {

extern const Integrator kRk4;
const Integrator kRk4 = {
    .name = "rk4",
    .summary = "the classical Runge-Kutta method, four evaluations a step",
    .order = 4,
    .symplectic = false,
    .leapfrog_stagger = 0,
    .default_orientation = "",
    .takes_joints = true,
    .holds_at_stages = true,
    .make = [](const StepperParts& parts) -> std::unique_ptr<Stepper> {
      return std::make_unique<ClassicalRungeKutta>(parts, OrientationChart::quaternion);
    },
};

}  // namespace rigor::inline dynamics
