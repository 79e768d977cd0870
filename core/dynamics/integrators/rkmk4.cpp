// The Runge–Kutta–Munthe-Kaas method of order 4 with the classical tableau (Munthe-Kaas, High order Runge–Kutta methods
// on manifolds, 1999). The orientation is R = exp([phi]x) R0. phi starts each step at zero, and the stages combine phi.
// Every stage is a rotation. Spins about an axis fixed in space are exact. Without torque L is exact, too.
#include "core/dynamics/integrators/classical_runge_kutta.h"

namespace rigor::inline dynamics {

extern const Integrator kRkmk4;
const Integrator kRkmk4 = {
    .name = "rkmk4",
    .summary = "Runge-Kutta-Munthe-Kaas: the classical stages on rotation vectors, so that rotations stay rotations",
    .order = 4,
    .symplectic = false,
    .leapfrog_stagger = 0,
    .default_orientation = "",
    .takes_joints = true,
    .holds_at_stages = true,
    .make = [](const StepperParts& parts) -> std::unique_ptr<Stepper> {
      return std::make_unique<ClassicalRungeKutta>(parts, OrientationChart::rotation_vector);
    },
};

}  // namespace rigor::inline dynamics
