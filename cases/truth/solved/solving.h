// The parts of every reference solution: its accepted steps, nodes between them at distances of one step of order 8,
// and its distance from other solutions. A `Motion` has start(), during(t), which is a right-hand side, and write().
// With constraints the right-hand side also projects a state onto them.
#pragma once

#include <algorithm>
#include <boost/numeric/odeint/stepper/controlled_step_result.hpp>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "cases/truth/solved/reference_solver.h"

namespace rigor::inline truth::solving {

using Extended = long double;

inline constexpr double kFirstStep = 1e-4;  // s
inline constexpr std::size_t kMostTries = 2'000'000;
inline constexpr double kMostBytes = 512e6;  // of nodes

// The accepted steps of one solution, rounded to double.
struct Nodes {
  std::vector<Extended> times;  // s
  std::vector<double> states;   // `dimension` numbers each
  std::size_t dimension = 0;
  Phases phases = {};
  bool complete = false;

  template <typename Real>
  void add(Extended t, const std::vector<Real>& state) {
    times.push_back(t);
    for (const Real& number : state) states.push_back(static_cast<double>(number));
  }
  bool is_full() const { return static_cast<double>(states.size()) * sizeof(double) > kMostBytes; }
};

// 0, the instants at which a timed force or a motor begins or ends, and the duration.
std::vector<double> switch_times(const Scene& scene, double duration);

// A Motion in double precision, with any equations. It fills in nodes and gives the state between them.
class DoubleMotion {
 public:
  using State = std::vector<double>;
  struct RightHandSide {
    std::function<void(const State& state, State& change, double t)> slope;
    std::function<bool(State& state)> project;  // onto the constraints; empty without constraints

    void operator()(const State& state, State& change, double t) const { slope(state, change, t); }
  };

  virtual ~DoubleMotion() = default;
  virtual RightHandSide during(double t) const = 0;  // used up by the next call
  virtual void write(const double* state, MutableBodyColumns out) const = 0;
};

template <typename Motion>
class InDouble final : public DoubleMotion {
 public:
  explicit InDouble(Motion motion) : motion_(std::move(motion)) {}

  RightHandSide during(double t) const override {
    const std::shared_ptr<Interval> system = interval(t);
    RightHandSide side;
    side.slope = [system](const State& state, State& change, double at) { (*system)(state, change, at); };
    if constexpr (requires(State & state) { system->project(state); }) {
      side.project = [system](State& state) { return system->project(state); };
    }
    return side;
  }
  void write(const double* state, MutableBodyColumns out) const override { motion_.write(state, out); }

 private:
  using Interval = typename Motion::Interval;

  // The same for all t where nothing begins or ends: laying out its equations takes longer than a step.
  std::shared_ptr<Interval> interval(double t) const {
    if constexpr (requires(Interval & kept) { kept.restart(), motion_.is_uniform(); }) {
      if (motion_.is_uniform()) {
        if (!throughout_) throughout_.reset(new auto(motion_.during(t)));
        throughout_->restart();
        return throughout_;
      }
    }
    return std::shared_ptr<Interval>(new auto(motion_.during(t)));  // it may not be moved
  }

  Motion motion_;
  mutable std::shared_ptr<Interval> throughout_;
};

template <typename Real>
bool finite(const std::vector<Real>& state) {
  return std::all_of(state.begin(), state.end(), [](const Real& number) { return number - number == 0; });
}

// Makes one accepted step from t towards `end`, of length h or less; returns false on failure.
template <typename Real, typename Stepper, typename System>
bool step_towards(Stepper& stepper, System& system, Real& t, Real end, Real& h, std::vector<Real>& state,
                  std::size_t& tries_left) {
  while (true) {
    const bool is_last = h >= end - t;
    if (is_last) h = end - t;
    if (t + h == t || tries_left-- == 0) return false;
    if (stepper.try_step(std::ref(system), state, t, h) == boost::numeric::odeint::fail) continue;
    if constexpr (std::is_same_v<System, DoubleMotion::RightHandSide>) {
      if (system.project && !system.project(state)) return false;
    } else if constexpr (requires { system.project(state); }) {
      if (!system.project(state)) return false;
    }
    if (is_last) t = end;
    return finite(state);
  }
}

// Steps from `begin` to `end`; false if it cannot get there.
template <typename Real, typename Stepper, typename System>
bool solve_interval(Stepper stepper, System& system, Real begin, Real end, std::vector<Real>& state, Nodes& nodes,
                    std::size_t tries_left) {
  Real t = begin, h = std::min<Real>(kFirstStep, end - begin);
  while (t < end) {
    if (nodes.is_full() || !step_towards(stepper, system, t, end, h, state, tries_left)) return false;
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

// The state at t: one step of order 8 from the node before it, so that there is no interpolation error.
std::vector<double> state_at(const ReferenceSolution& solution, const DoubleMotion& motion, double t);

// One solution, and how far others are from it at each of their nodes.
class Judged {
 public:
  // Fills in the nodes of `first`, so that from each to the next is one step of order 8.
  Judged(std::unique_ptr<DoubleMotion> motion, std::size_t bodies, const Nodes& first);
  // `write`: the bodies of a state of the other.
  void compare(const std::function<void(const double* state, MutableBodyColumns out)>& write, const Nodes& other);
  ReferenceSolution solution();

 private:
  std::unique_ptr<DoubleMotion> motion_;
  std::size_t bodies_;
  ReferenceSolution solution_;
  std::vector<std::pair<double, double>> errors_;  // at times
};

}  // namespace rigor::inline truth::solving
