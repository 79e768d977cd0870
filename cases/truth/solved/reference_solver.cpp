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
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "cases/truth/solved/extrapolation.h"

namespace rigor {
namespace {

namespace odeint = boost::numeric::odeint;

using Extended = long double;
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
constexpr double kFillTolerance = 1e-15;  // some five roundings of a double

// Of the distance between the solutions: all err alike, by roundings that the motion magnifies, and one of the others
// may for a while err as the first does.
constexpr double kSafety = 3;

constexpr double kWantedError = 1e-12;  // m and rad, at the end
constexpr double kMostQuadWork = 1e6;   // changes of a body or spring, of some 5 µs each
constexpr double kFirstStep = 1e-4;     // s
constexpr std::size_t kMostTries = 2'000'000;
constexpr double kMostBytes = 512e6;  // of nodes

// The accepted steps of one solution, rounded to double.
struct Nodes {
  std::vector<Extended> times;  // s
  std::vector<double> states;   // `dimension` numbers each
  std::size_t dimension = 0;
  bool complete = false;

  template <typename Real>
  void add(Extended t, const std::vector<Real>& state) {
    times.push_back(t);
    for (const Real& number : state) states.push_back(static_cast<double>(number));
  }
};

// 0, the instants at which a timed force begins or ends, and the duration.
std::vector<double> switch_times(const Scene& scene, double duration) {
  std::vector<double> times = {0, duration};
  for (const TimedForce& force : scene.forces) {
    for (const double t : {force.from, force.until}) {
      if (t > 0 && t < duration) times.push_back(t);
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

template <typename Real>
bool finite(const std::vector<Real>& state) {
  return std::all_of(state.begin(), state.end(), [](const Real& number) { return number - number == 0; });
}

// Steps from `begin` to `end`; false if it cannot get there.
template <typename Real, typename Stepper, typename System>
bool solve_interval(Stepper stepper, System& system, Real begin, Real end, std::vector<Real>& state, Nodes& nodes,
                    std::size_t most_tries) {
  Real t = begin, h = std::min<Real>(kFirstStep, end - begin);
  for (std::size_t tries = 0; t < end; ++tries) {
    const bool is_last = h >= end - t;
    if (is_last) h = end - t;
    if (t + h == t || tries == most_tries || static_cast<double>(nodes.states.size()) * sizeof(double) > kMostBytes)
      return false;
    if (stepper.try_step(std::ref(system), state, t, h) == odeint::fail) continue;
    if (!finite(state)) return false;
    if (is_last) t = end;
    nodes.add(static_cast<Extended>(t), state);
  }
  return true;
}

template <typename Real, typename Stepper>
Nodes solve(const EquationsOfMotion<Real>& motion, const Stepper& stepper, const std::vector<double>& switches,
            std::size_t most_tries) {
  std::vector<Real> state = motion.start();
  Nodes nodes;
  nodes.dimension = state.size();
  nodes.add(0, state);
  for (std::size_t i = 0; i + 1 < switches.size(); ++i) {
    auto system = motion.during(0.5 * (switches[i] + switches[i + 1]));
    if (!solve_interval<Real>(stepper, system, switches[i], switches[i + 1], state, nodes, most_tries)) {
      return nodes;
    }
  }
  nodes.complete = true;
  return nodes;
}

// Nodes with others between them, so near to each other that from each to the next is one step of order 8.
Nodes filled_in(const Nodes& nodes, const EquationsOfMotion<double>& motion) {
  using State = std::vector<double>;
  const auto fehlberg =
      odeint::make_controlled(kFillTolerance, kFillTolerance, odeint::runge_kutta_fehlberg78<State>());
  Nodes filled;
  filled.dimension = nodes.dimension;
  for (std::size_t i = 0; i < nodes.times.size(); ++i) {
    State state(&nodes.states[i * nodes.dimension], &nodes.states[(i + 1) * nodes.dimension]);
    filled.add(nodes.times[i], state);
    if (i + 1 == nodes.times.size()) break;
    const Extended begin = nodes.times[i], length = nodes.times[i + 1] - begin;
    auto system = motion.during(static_cast<double>(begin + length / 2));
    Nodes between;
    if (!solve_interval<double>(fehlberg, system, 0, static_cast<double>(length), state, between, kMostTries))
      return filled;
    // The last is the next of `nodes`.
    for (std::size_t k = 0; k + 1 < between.times.size(); ++k) filled.times.push_back(begin + between.times[k]);
    filled.states.insert(filled.states.end(), between.states.begin(), between.states.end() - nodes.dimension);
  }
  filled.complete = nodes.complete;
  return filled;
}

// The largest distance [m] and angle [rad] between the same body of two tables, and of roundings in them.
double distance(BodyColumns a, BodyColumns b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest =
        std::max({largest, (a.position(i) - b.position(i)).norm(), angle_between(a.orientation(i), b.orientation(i))});
  }
  return largest;
}

double rounding(BodyColumns bodies) {
  double largest = 1;  // of a unit quaternion
  for (std::size_t i = 0; i < bodies.size(); ++i) largest = std::max(largest, bodies.position(i).norm());
  return 4 * std::numeric_limits<double>::epsilon() * largest;
}

// One solution, and how far others are from it at each of their nodes.
class Judged {
 public:
  Judged(const Scene& scene, const Nodes& first) : motion_(scene, kReferenceForm), bodies_(scene.bodies.size()) {
    Nodes filled = filled_in(first, motion_);
    solution_.dimension = filled.dimension;
    solution_.times = std::move(filled.times), solution_.states = std::move(filled.states);
    solution_.complete = filled.complete;
  }

  void compare(const EquationsOfMotion<double>& other_motion, const Nodes& other) {
    BodyTable here(bodies_), there(bodies_);
    for (std::size_t i = 0; i < other.times.size() && other.times[i] <= solution_.times.back(); ++i) {
      const auto t = static_cast<double>(other.times[i]);
      motion_.write(state_at(solution_, motion_, t).data(), here.columns());
      other_motion.write(&other.states[i * other.dimension], there.columns());
      const double apart = distance(here.columns(), there.columns());
      errors_.emplace_back(t, kSafety * apart + rounding(here.columns()));
    }
    solution_.complete = solution_.complete && other.complete;
  }

  ReferenceSolution solution() {
    std::sort(errors_.begin(), errors_.end());
    double largest = 0;
    for (const auto& [t, error] : errors_) {
      largest = std::max(largest, error);
      solution_.error_times.push_back(t);
      solution_.errors.push_back(largest);
    }
    return std::move(solution_);
  }

 private:
  EquationsOfMotion<double> motion_;
  std::size_t bodies_;
  ReferenceSolution solution_;
  std::vector<std::pair<double, double>> errors_;  // at times
};

// The first of the methods' solutions, judged by the others.
template <typename Real>
ReferenceSolution solve_by(const std::vector<Method>& methods, const Scene& scene, double duration,
                           std::size_t most_tries) {
  const std::vector<double> switches = switch_times(scene, duration);
  const auto nodes_of = [&](const Method& method) {
    const Extrapolation<Real> stepper(method.columns, method.tolerance);
    return solve(EquationsOfMotion<Real>(scene, method.form), stepper, switches, most_tries);
  };
  Judged judged(scene, nodes_of(methods.front()));
  for (std::size_t i = 1; i < methods.size(); ++i) {
    judged.compare(EquationsOfMotion<double>(scene, methods[i].form), nodes_of(methods[i]));
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

ReferenceSolution solve_reference(const Scene& scene, double duration) {
  ReferenceSolution extended = solve_by<Extended>(kMethods, scene, duration, kMostTries);
  const bool is_good = extended.complete && extended.errors.back() <= kWantedError;
  const std::size_t steps = extended.error_times.size() / (kMethods.size() - 1);
  if (is_good || !extended.complete || quad_work(steps, scene) > kMostQuadWork) return extended;
  ReferenceSolution quad = solve_by<Quad>(kQuadMethods, scene, duration, 4 * steps);
  return quad.complete && quad.errors.back() < extended.errors.back() ? quad : extended;
}

std::vector<double> state_at(const ReferenceSolution& solution, const EquationsOfMotion<double>& motion, double t) {
  const auto after = std::upper_bound(solution.times.begin(), solution.times.end(), static_cast<Extended>(t));
  const std::size_t node = after == solution.times.begin() ? 0 : after - solution.times.begin() - 1;
  const auto first = solution.states.begin() + node * solution.dimension;
  std::vector<double> state(first, first + solution.dimension);
  const double h = after == solution.times.end() ? 0 : static_cast<double>(t - solution.times[node]);
  if (h > 0) {
    auto system = motion.during(static_cast<double>((solution.times[node] + *after) / 2));
    odeint::runge_kutta_fehlberg78<std::vector<double>>().do_step(std::ref(system), state, 0.0, h);
  }
  return state;
}

}  // namespace rigor
