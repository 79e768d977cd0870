// Solves by Gragg's extrapolation (extrapolation.h) in extended precision. The solution uses body rates. A second
// solution, for the error, uses angular momenta, another order and another tolerance. Both go from one switch of a
// timed force to the next, so that no step crosses a jump.
//
// Near a separatrix or in chaos every rounding is magnified, and the error may be too large. Both solutions are then
// repeated in quadruple precision, if that takes only a few seconds. The steps are long. Between two steps Fehlberg's
// Runge-Kutta pair of order 8(7) fills in nodes, in double precision and starting again at each step's end (Hairer,
// Nørsett, Wanner, Solving Ordinary Differential Equations I, sections II.5 and II.9).
#include "cases/truth/solved/reference_solver.h"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "cases/truth/solved/extrapolation.h"
#include "cases/truth/solved/solving.h"

namespace rigor::inline truth {
namespace {

using namespace solving;
using Quad = boost::multiprecision::cpp_bin_float_quad;

// `tolerance` is the allowed error of an extrapolated step, relative and absolute. It bounds the error of the next
// lower order, so the step's own error is at rounding level. The columns of the table magnify rounding. With more
// columns, or a smaller tolerance, steps would shrink because of errors that no step can reduce. The value is some four
// hundred roundings of a long double or more, and ten million of a quadruple.
struct Method {
  Formulation form;
  int columns;
  double tolerance;
};
const std::vector<Method> kMethods = {
    {kReferenceForm, 6, 4e-17}, {Formulation::momentum, 7, 2e-16}, {kReferenceForm, 7, 2e-16}};
const std::vector<Method> kQuadMethods = {{kReferenceForm, 12, 1e-27}, {Formulation::momentum, 10, 2e-27}};

constexpr double kWantedError = 1e-12;  // m and rad, at the end
constexpr double kMostQuadWork = 1e6;   // changes of a body or spring, of some 5 µs each

std::unique_ptr<DoubleMotion> free_motion_in_double(const Scene& scene, Formulation form) {
  return std::make_unique<InDouble<EquationsOfMotion<double>>>(EquationsOfMotion<double>(scene, form));
}

// The first of the methods' solutions, judged by the others.
template <typename Real>
ReferenceSolution solve_by(const std::vector<Method>& methods, const Scene& scene, double duration,
                           std::size_t most_tries) {
  const std::vector<double> switches = switch_times(scene, duration);
  const auto nodes_of = [&](const Method& method) {
    const Extrapolation<Real> stepper(method.columns, method.tolerance);
    return solve(EquationsOfMotion<Real>(scene, method.form), stepper, switches, most_tries);
  };
  Judged judged(free_motion_in_double(scene, kReferenceForm), scene.bodies.size(), nodes_of(methods.front()));
  for (std::size_t i = 1; i < methods.size(); ++i) {
    const auto motion = free_motion_in_double(scene, methods[i].form);
    judged.compare([&](const double* state, MutableBodyColumns out) { motion->write(state, out); },
                   nodes_of(methods[i]));
  }
  return judged.solution();
}

// A step of quadruple precision is about as long as one of extended.
double quad_work(std::size_t steps, const Scene& scene) {
  double evaluations = 0;
  for (const Method& method : kQuadMethods) evaluations += method.columns * (method.columns + 1);
  const std::size_t loads = scene.bodies.size() + scene.springs.size() + scene.forces.size();
  return evaluations * static_cast<double>(steps * loads);
}

}  // namespace

std::unique_ptr<DoubleMotion> reference_motion(const Scene& scene, const ReferenceSolution& solution) {
  return scene.joints.empty() ? free_motion_in_double(scene, kReferenceForm)
                              : jointed_motion_in_double(scene, solution);
}

ReferenceSolution solve_reference(const Scene& scene, double duration) {
  if (!scene.joints.empty()) return solve_jointed_reference(scene, duration);
  ReferenceSolution extended = solve_by<Extended>(kMethods, scene, duration, kMostTries);
  const bool is_good = extended.complete && extended.errors.back() <= kWantedError;
  const std::size_t steps = extended.error_times.size() / (kMethods.size() - 1);
  if (is_good || !extended.complete || quad_work(steps, scene) > kMostQuadWork) return extended;
  ReferenceSolution quad = solve_by<Quad>(kQuadMethods, scene, duration, 4 * steps);
  return quad.complete && quad.errors.back() < extended.errors.back() ? quad : extended;
}

}  // namespace rigor::inline truth
