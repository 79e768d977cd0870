// The reference of jointed scenes, in extended precision: Newton and Euler's accelerations with the joints' forces
// (jointed_motion.h) for the solution, and beside it, for its error, the same bodies by natural coordinates
// (natural_coordinates.h), which share no equation with them, and the first once more with other steps. Each is
// projected onto its constraints after each step.
#include "cases/truth/solved/extrapolation.h"
#include "cases/truth/solved/jointed_motion.h"
#include "cases/truth/solved/natural_coordinates.h"
#include "cases/truth/solved/reference_solver.h"
#include "cases/truth/solved/solving.h"

namespace rigor {
namespace {

using namespace solving;

// What an extrapolation allows a step (reference_solver.cpp says why no less). The equations for the joints' forces
// magnify roundings by what they are ill-conditioned.
struct StepRule {
  int columns;
  double tolerance;
};
constexpr StepRule kSolution{6, 4e-16}, kBeside{7, 1e-15}, kAgain{8, 1e-15};

template <typename Motion>
Nodes nodes_of(const Motion& motion, StepRule rule, const std::vector<double>& switches) {
  return solve(motion, Extrapolation<Extended>(rule.columns, rule.tolerance), switches, kMostTries);
}

}  // namespace

ReferenceSolution solve_jointed_reference(const Scene& scene, double duration) {
  const std::vector<double> switches = switch_times(scene, duration);
  const JointedMotion<Extended> motion(scene);
  const JointedMotion<double> rounded(scene);
  Judged judged(rounded, scene.bodies.size(), nodes_of(motion, kSolution, switches));
  const NaturalCoordinates<Extended> beside(scene);
  judged.compare(beside, nodes_of(beside, kBeside, switches));
  judged.compare(rounded, nodes_of(motion, kAgain, switches));
  return judged.solution();
}

}  // namespace rigor
