// A composition of order 8: seventeen leapfrogs with the weights of Kahan and Li. Source: Composition constants for
// raising the orders of unconventional schemes for ordinary differential equations, 1997.
#include <array>

#include "core/dynamics/integrators/leapfrog_composition.h"

namespace rigor::inline dynamics {

namespace {

constexpr double g1 = 0.13020248308889008087881763, g2 = 0.56116298177510838456196441,
                 g3 = -0.38947496264484728640807860, g4 = 0.15884190655515560089621075,
                 g5 = -0.39590389413323757733623154, g6 = 0.18453964097831570709183254,
                 g7 = 0.25837438768632204729397911, g8 = 0.29501172360931029887096624,
                 g9 = -0.60550853383003451169892108;
constexpr std::array<double, 17> kWeights8 = {g1, g2, g3, g4, g5, g6, g7, g8, g9, g8, g7, g6, g5, g4, g3, g2, g1};

}  // namespace

extern const Integrator kSymplectic8;
const Integrator kSymplectic8 = {
    .name = "symplectic8",
    .summary = "seventeen leapfrogs a step in the composition of Kahan and Li; keeps |L| to rounding",
    .order = 8,
    .symplectic = true,
    .symmetric = true,
    .leapfrog_stagger = 0,
    .default_orientation = "",
    .takes_joints = true,
    .takes_dampers_with_joints = false,  // its damped kick is not yet solved together with the joints' impulse
    .make = [](const StepperParts& parts) -> std::unique_ptr<Stepper> {
      return std::make_unique<LeapfrogComposition>(parts, kWeights8);
    },
};

}  // namespace rigor::inline dynamics
