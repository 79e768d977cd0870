// The Runge–Kutta–Munthe-Kaas method of order 4 with the classical tableau (Munthe-Kaas, High order Runge–Kutta methods
// on manifolds, 1999): the orientation is R = exp([phi]x) R0, and phi, which starts each step at zero, is what the
// stages combine. No stage leaves the rotations. Spins about an axis fixed in space are exact; without torque L is,
// too.
#include "core/dynamics/integrators/classical_runge_kutta.h"

namespace rigor {

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

}  // namespace rigor
