// What every solution of the reference is made of: its accepted steps, nodes between them that are one step of order 8
// apart, and how far it is from other solutions. A `Motion` has start(), during(t), which is a right-hand side, and
// write(); one with constraints has a right-hand side that projects a state onto them.
#pragma once

#include <algorithm>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "cases/truth/solved/reference_solver.h"

namespace rigor::solving {

using Extended = long double;

inline constexpr double kFillTolerance = 1e-15;  // some five roundings of a double

// Of the distance between the solutions: all err alike, by roundings that the motion magnifies, and one of the others
// may for a while err as the first does.
inline constexpr double kSafety = 3;

inline constexpr double kFirstStep = 1e-4;  // s
inline constexpr std::size_t kMostTries = 2'000'000;
inline constexpr double kMostBytes = 512e6;  // of nodes

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

// 0, the instants at which a timed force or a motor begins or ends, and the duration.
inline std::vector<double> switch_times(const Scene& scene, double duration) {
  std::vector<double> times = {0, duration};
  const auto add = [&](const auto& load) {
    for (const double t : {load.from, load.until}) {
      if (t > 0 && t < duration) times.push_back(t);
    }
  };
  for (const TimedForce& force : scene.forces) add(force);
  for (const Motor& motor : scene.motors) add(motor);
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
    if (stepper.try_step(std::ref(system), state, t, h) == boost::numeric::odeint::fail) continue;
    if constexpr (requires { system.project(state); }) {
      if (!system.project(state)) return false;
    }
    if (!finite(state)) return false;
    if (is_last) t = end;
    nodes.add(static_cast<Extended>(t), state);
  }
  return true;
}

template <typename Motion, typename Stepper>
Nodes solve(const Motion& motion, const Stepper& stepper, const std::vector<double>& switches, std::size_t most_tries) {
  typename Motion::State state = motion.start();
  using Real = typename Motion::State::value_type;
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
template <typename Motion>
Nodes filled_in(const Nodes& nodes, const Motion& motion) {
  using State = std::vector<double>;
  const auto fehlberg = boost::numeric::odeint::make_controlled(
      kFillTolerance, kFillTolerance, boost::numeric::odeint::runge_kutta_fehlberg78<State>());
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
inline double distance(BodyColumns a, BodyColumns b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest =
        std::max({largest, (a.position(i) - b.position(i)).norm(), angle_between(a.orientation(i), b.orientation(i))});
  }
  return largest;
}

inline double rounding(BodyColumns bodies) {
  double largest = 1;  // of a unit quaternion
  for (std::size_t i = 0; i < bodies.size(); ++i) largest = std::max(largest, bodies.position(i).norm());
  return 4 * std::numeric_limits<double>::epsilon() * largest;
}

// The state at t: one step of order 8 from the node before it, so that there is no interpolation error.
template <typename Motion>
std::vector<double> state_at(const ReferenceSolution& solution, const Motion& motion, double t) {
  const auto after = std::upper_bound(solution.times.begin(), solution.times.end(), static_cast<Extended>(t));
  const std::size_t node = after == solution.times.begin() ? 0 : after - solution.times.begin() - 1;
  const auto first = solution.states.begin() + node * solution.dimension;
  std::vector<double> state(first, first + solution.dimension);
  const double h = after == solution.times.end() ? 0 : static_cast<double>(t - solution.times[node]);
  if (h > 0) {
    auto system = motion.during(static_cast<double>((solution.times[node] + *after) / 2));
    boost::numeric::odeint::runge_kutta_fehlberg78<std::vector<double>>().do_step(std::ref(system), state, 0.0, h);
  }
  return state;
}

// One solution, and how far others are from it at each of their nodes.
template <typename Motion>
class Judged {
 public:
  Judged(Motion motion, std::size_t bodies, const Nodes& first) : motion_(std::move(motion)), bodies_(bodies) {
    Nodes filled = filled_in(first, motion_);
    solution_.dimension = filled.dimension;
    solution_.times = std::move(filled.times), solution_.states = std::move(filled.states);
    solution_.complete = filled.complete;
  }

  template <typename Other>
  void compare(const Other& other_motion, const Nodes& other) {
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
  Motion motion_;
  std::size_t bodies_;
  ReferenceSolution solution_;
  std::vector<std::pair<double, double>> errors_;  // at times
};

}  // namespace rigor::solving
