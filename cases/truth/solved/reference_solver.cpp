// By Gragg's extrapolation (extrapolation.h) in extended precision: with body rates for the solution, and beside it,
// for its error, with angular momenta, another order and another tolerance. Both go from one switch of a timed force to
// the next, so that no step straddles a jump.
//
// Where that leaves more of an error than is wanted (near a separatrix, or in chaos, which magnify every rounding),
// solutions are found again in quadruple precision, if that takes but a few seconds. The steps are long: between
// two of them Fehlberg's Runge-Kutta pair of order 8(7) fills in nodes, in double precision and afresh from each step's
// end (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, sections II.5 and II.9).
#include "cases/truth/solved/reference_solver.h"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "cases/truth/solved/extrapolation.h"
#include "cases/truth/solved/solving.h"

namespace rigor {
namespace {

using namespace solving;
using Quad = boost::multiprecision::cpp_bin_float_quad;

// `tolerance` is what an extrapolation allows a step, relative and absolute: the error of the order below its own, so
// that its own is left with roundings. Its columns magnify these: with more of them, or less of a tolerance, steps
// would shrink for what no step can mend. Here it is some four hundred roundings of a long double or more, and ten
// million of a quadruple.
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

}  // namespace rigor
