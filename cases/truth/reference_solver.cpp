// First by Fehlberg's Runge-Kutta pair of order 8(7) with body rates, in extended precision; beside it, for the error,
// by Gragg-Bulirsch-Stoer extrapolation with angular momenta, at a looser tolerance (Hairer, Nørsett, Wanner, Solving
// Ordinary Differential Equations I, sections II.5 and II.9). All go from one switch of a timed force to the next, so
// that no step straddles a jump.
//
// Where that leaves more of an error than is wanted (near a separatrix, or in chaos, which magnify every rounding),
// both solutions are found again in quadruple precision, by extrapolations of two orders, if that takes but a few
// seconds. Its steps are long: between two of them Fehlberg's pair fills in the nodes.
#include "cases/truth/reference_solver.h"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <type_traits>

#include "cases/truth/extrapolation.h"

namespace rigor {
namespace {

namespace odeint = boost::numeric::odeint;

using Extended = long double;
using Quad = boost::multiprecision::cpp_bin_float_quad;

// Relative and absolute, per step: some ten and twenty roundings of a long double. Extrapolation magnifies roundings,
// so that below that its steps would shrink without end.
constexpr Extended kTolerance = 1e-18L, kSecondTolerance = 2e-18L;
// Ten million roundings of a quadruple, more than K = 12 magnifies them.
constexpr double kQuadTolerance = 1e-27, kSecondQuadTolerance = 2e-27;
constexpr int kQuadColumns = 12, kSecondQuadColumns = 10;

constexpr double kWantedError = 1e-12;  // m and rad, at the end
constexpr double kMostQuadWork = 1e6;   // changes of a body or spring, of some 5 µs each
constexpr double kFirstStep = 1e-4;     // s
constexpr std::size_t kMostTries = 2'000'000;
constexpr double kMostBytes = 512e6;  // of nodes

// The accepted steps of one solution, rounded: a quadruple's to extended, to be filled in; an extended's to double.
template <typename Real>
struct Nodes {
  using Rounded = std::conditional_t<std::is_same_v<Real, Quad>, Extended, double>;

  std::vector<Extended> times;  // s
  std::vector<Rounded> states;  // `dimension` numbers each
  std::size_t dimension = 0;
  bool complete = false;

  void add(const Real& t, const std::vector<Real>& state) {
    times.push_back(static_cast<Extended>(t));
    for (const Real& number : state) states.push_back(static_cast<Rounded>(number));
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
bool solve_interval(Stepper stepper, System& system, Real begin, Real end, std::vector<Real>& state, Nodes<Real>& nodes,
                    std::size_t most_tries = kMostTries) {
  Real t = begin, h = std::min<Real>(kFirstStep, end - begin);
  for (std::size_t tries = 0; t < end; ++tries) {
    const bool is_last = h >= end - t;
    if (is_last) h = end - t;
    if (t + h == t || tries == most_tries || static_cast<double>(nodes.states.size()) * sizeof(double) > kMostBytes)
      return false;
    if (stepper.try_step(std::ref(system), state, t, h) == odeint::fail) continue;
    if (!finite(state)) return false;
    if (is_last) t = end;
    nodes.add(t, state);
  }
  return true;
}

template <typename Real, typename Stepper>
Nodes<Real> solve(const EquationsOfMotion<Real>& motion, const Stepper& stepper, const std::vector<double>& switches,
                  std::size_t most_tries = kMostTries) {
  std::vector<Real> state = motion.start();
  Nodes<Real> nodes;
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

auto fehlberg() {
  using State = std::vector<Extended>;
  return odeint::make_controlled(kTolerance, kTolerance,
                                 odeint::runge_kutta_fehlberg78<State, Extended, State, Extended>());
}

// Nodes of quadruple precision, with those of an extended solution from each to the next between them.
Nodes<Extended> filled_in(const Nodes<Quad>& quad, const EquationsOfMotion<Extended>& motion) {
  Nodes<Extended> nodes;
  nodes.dimension = quad.dimension;
  for (std::size_t i = 0; i < quad.times.size(); ++i) {
    const auto first = quad.states.begin() + i * quad.dimension;
    std::vector<Extended> state(first, first + quad.dimension);
    const Extended t = quad.times[i];
    nodes.add(t, state);
    if (i + 1 == quad.times.size()) break;
    const Extended next = quad.times[i + 1];
    auto system = motion.during(static_cast<double>((t + next) / 2));
    if (!solve_interval<Extended>(fehlberg(), system, t, next, state, nodes)) return nodes;
    // The quadruple's own node takes the place of the last.
    nodes.times.pop_back();
    nodes.states.resize(nodes.states.size() - nodes.dimension);
  }
  nodes.complete = quad.complete;
  return nodes;
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

// One solution as the truth, and its distance from the other at each of that one's nodes.
template <typename Real>
ReferenceSolution judged(const Scene& scene, const Nodes<Extended>& first, const EquationsOfMotion<Real>& second_motion,
                         const Nodes<Real>& second) {
  ReferenceSolution solution;
  solution.dimension = first.dimension, solution.times = first.times, solution.states = first.states;
  const EquationsOfMotion<double> motion(scene, kReferenceForm);
  BodyTable here(scene.bodies.size()), there(scene.bodies.size());
  double largest = 0;
  for (std::size_t i = 0; i < second.times.size() && second.times[i] <= first.times.back(); ++i) {
    const auto t = static_cast<double>(second.times[i]);
    motion.write(state_at(solution, motion, t).data(), here.columns());
    second_motion.write(&second.states[i * second.dimension], there.columns());
    largest = std::max(largest, distance(here.columns(), there.columns()) + rounding(here.columns()));
    solution.error_times.push_back(t);
    solution.errors.push_back(largest);
  }
  solution.complete = first.complete && second.complete;
  return solution;
}

ReferenceSolution solve_extended(const Scene& scene, const std::vector<double>& switches) {
  using State = std::vector<Extended>;
  const EquationsOfMotion<Extended> motion(scene, kReferenceForm), second_motion(scene, Formulation::momentum);
  const odeint::bulirsch_stoer<State, Extended, State, Extended> second(kSecondTolerance, kSecondTolerance);
  return judged(scene, solve(motion, fehlberg(), switches), second_motion, solve(second_motion, second, switches));
}

ReferenceSolution solve_quad(const Scene& scene, const std::vector<double>& switches, std::size_t most_tries) {
  const EquationsOfMotion<Quad> motion(scene, kReferenceForm), second_motion(scene, Formulation::momentum);
  const Extrapolation<Quad> first(kQuadColumns, kQuadTolerance), second(kSecondQuadColumns, kSecondQuadTolerance);
  const Nodes<Quad> nodes = solve(motion, first, switches, most_tries);
  if (!nodes.complete) return {};
  return judged(scene, filled_in(nodes, EquationsOfMotion<Extended>(scene, kReferenceForm)), second_motion,
                solve(second_motion, second, switches, most_tries));
}

// An extrapolation's step is about ten times as long as Fehlberg's, and evaluates about as many times more.
double quad_work(const ReferenceSolution& solution, const Scene& scene) {
  constexpr double kEvaluations = 2 * 15;  // of both solutions, for each of Fehlberg's steps
  const std::size_t loads = scene.bodies.size() + scene.springs.size() + scene.forces.size();
  return kEvaluations * static_cast<double>(solution.times.size() * loads);
}

}  // namespace

ReferenceSolution solve_reference(const Scene& scene, double duration) {
  const std::vector<double> switches = switch_times(scene, duration);
  ReferenceSolution extended = solve_extended(scene, switches);
  const bool is_good = extended.complete && extended.errors.back() <= kWantedError;
  if (is_good || !extended.complete || quad_work(extended, scene) > kMostQuadWork) return extended;
  ReferenceSolution quad = solve_quad(scene, switches, extended.times.size());
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
