// The reference of jointed scenes: Newton and Euler's accelerations with the joints' forces (jointed_motion.h), in
// extended precision, for the solution, and beside it, for its error, the same bodies by natural coordinates
// (natural_coordinates.h), in double, which share no equation with them. Each is projected onto its constraints after
// each step. The error so is that of the second, some 1e-12 m and rad where nothing magnifies roundings.
#include "cases/truth/solved/extrapolation.h"
#include "cases/truth/solved/jointed_motion.h"
#include "cases/truth/solved/natural_coordinates.h"
#include "cases/truth/solved/reference_solver.h"
#include "cases/truth/solved/solving.h"

namespace rigor {
namespace {

using namespace solving;

// What an extrapolation allows a step, relative and absolute (reference_solver.cpp says why no less): the equations for
// the joints' forces magnify roundings by what they are ill-conditioned.
template <typename Real, typename Motion>
Nodes nodes_of(const Motion& motion, int columns, double tolerance, const std::vector<double>& switches) {
  return solve(motion, Extrapolation<Real>(columns, tolerance), switches, kMostTries);
}

}  // namespace

std::unique_ptr<DoubleMotion> jointed_motion_in_double(const Scene& scene) {
  return std::make_unique<InDouble<JointedMotion<double>>>(JointedMotion<double>(scene));
}

ReferenceSolution solve_jointed_reference(const Scene& scene, double duration) {
  const std::vector<double> switches = switch_times(scene, duration);
  const auto nodes = nodes_of<Extended>(JointedMotion<Extended>(scene), 6, 1e-15, switches);
  Judged judged(jointed_motion_in_double(scene), scene.bodies.size(), nodes);
  const NaturalCoordinates<double> beside(scene);
  judged.compare([&](const double* state, MutableBodyColumns out) { beside.write(state, out); },
                 nodes_of<double>(beside, 5, 1e-12, switches));
  return judged.solution();
}

}  // namespace rigor
