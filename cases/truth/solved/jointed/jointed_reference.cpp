// The reference of jointed scenes, solved in two ways. The solution uses accelerations of Newton and Euler with the
// joints' forces (jointed_motion.h), in extended precision. The second, for the error, uses natural coordinates
// (natural_coordinates.h) in double precision and shares no equation with the first. Each is projected onto its
// constraints after each step, and finds its own events (stopped_solution.h). The error is thus that of the second,
// some 1e-12 m and rad unless the motion magnifies rounding. If it does, and solving takes only a few seconds, both are
// repeated: the first with a smaller tolerance, the second in extended precision, too.
#include "cases/truth/solved/jointed/jointed_ways.h"
#include "cases/truth/solved/reference_solver.h"

namespace rigor::inline truth {
namespace {

using namespace solving;

// Tolerances; reference_solver.cpp explains the lower bound. The equations of the joint forces magnify rounding by
// their condition number.
constexpr Way kFirst = {6, 1e-15, 1e-7}, kBeside = {5, 1e-12, 2e-7};
constexpr Way kFirstFiner = {7, 2e-17, 1e-7}, kBesideFiner = {6, 1e-16, 2e-7};

constexpr double kWantedJointedError = 1e-10;  // m and rad, at the end
constexpr double kMostFinerWork = 4e5;         // changes of a body in extended precision, of some 8 µs each

ReferenceSolution judged(const Scene& scene, const solving::Nodes& nodes, Precision precision, const Way& beside,
                         const std::vector<double>& switches) {
  Judged judging(newton_euler_in_double(scene, nodes), scene.bodies.size(), nodes);
  compare_with_natural(judging, precision, scene, beside, switches);
  return judging.solution();
}

double work(const solving::Nodes& nodes, const Way& way, const Scene& scene) {
  const double changes = way.columns * (way.columns + 1);
  return changes * static_cast<double>(nodes.times.size() * scene.bodies.size());
}

}  // namespace

ReferenceSolution solve_jointed_reference(const Scene& scene, double duration) {
  const std::vector<double> switches = switch_times(scene, duration);
  const solving::Nodes nodes = newton_euler_nodes(scene, kFirst, switches);
  ReferenceSolution solution = judged(scene, nodes, Precision::plain, kBeside, switches);
  const bool is_good = !solution.complete || solution.errors.back() <= kWantedJointedError;
  if (is_good || work(nodes, kFirst, scene) > kMostFinerWork) return solution;
  const solving::Nodes finer = newton_euler_nodes(scene, kFirstFiner, switches);
  ReferenceSolution again = judged(scene, finer, Precision::extended, kBesideFiner, switches);
  return again.complete && again.errors.back() < solution.errors.back() ? again : solution;
}

}  // namespace rigor::inline truth
