#include "cases/truth/solved/solving.h"

#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <limits>

#include "cases/truth/distance.h"

namespace rigor::inline truth::solving {
namespace {

constexpr double kFillTolerance = 1e-15;  // some five roundings of a double

// Applied to the distance between the solutions. All have similar errors, from rounding that the motion magnifies, and
// another solution may for a while have the same error as the first.
constexpr double kSafety = 3;

// Nodes with others between them, so near to each other that from each to the next is one step of order 8.
Nodes filled_in(const Nodes& nodes, const DoubleMotion& motion) {
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
    if (length == 0) continue;  // an impact
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

// The largest rounding in a table, in m and rad.
double rounding(BodyColumns bodies) {
  double largest = 1;  // of a unit quaternion
  for (std::size_t i = 0; i < bodies.size(); ++i) largest = std::max(largest, bodies.position(i).norm());
  return 4 * std::numeric_limits<double>::epsilon() * largest;
}

}  // namespace

std::vector<double> switch_times(const Scene& scene, double duration) {
  std::vector<double> times = {0, duration};
  const auto add = [&](const auto& load) {
    for (const double t : {load.from, load.until}) {
      if (t > 0 && t < duration) times.push_back(t);
    }
  };
  for (const TimedForce& force : scene.forces) add(force);
  for (const Motor& motor : scene.motors) {
    add(motor);
    const auto add_times = [&](const std::vector<double>& table) {
      std::copy_if(table.begin(), table.end(), std::back_inserter(times),
                   [&](double t) { return t > std::max(0.0, motor.from) && t < std::min(duration, motor.until); });
    };
    if (motor.efforts) add_times(motor.efforts->times);
    if (!motor.servo) continue;
    add_times(motor.servo->target.times);
    const double period = motor.servo->period;
    for (double n = 1;
         period > 0 && std::isfinite(duration) && motor.from + n * period < std::min(duration, motor.until); ++n)
      times.push_back(motor.from + n * period);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::vector<double> state_at(const ReferenceSolution& solution, const DoubleMotion& motion, double t) {
  using State = std::vector<double>;
  namespace odeint = boost::numeric::odeint;
  // Kept from call to call for the room of its thirteen stages, which takes longer to make than a step of one body.
  thread_local odeint::runge_kutta_fehlberg78<State, double, State, double, odeint::range_algebra,
                                              odeint::default_operations, odeint::always_resizer>
      fehlberg;
  const auto after = std::upper_bound(solution.times.begin(), solution.times.end(), static_cast<Extended>(t));
  const std::size_t node = after == solution.times.begin() ? 0 : after - solution.times.begin() - 1;
  const auto first = solution.states.begin() + node * solution.dimension;
  State state(first, first + solution.dimension);
  const double h = after == solution.times.end() ? 0 : static_cast<double>(t - solution.times[node]);
  if (h > 0) {
    auto system = motion.during(static_cast<double>((solution.times[node] + *after) / 2));
    fehlberg.do_step(std::ref(system), state, 0.0, h);
  }
  return state;
}

Judged::Judged(std::unique_ptr<DoubleMotion> motion, std::size_t bodies, const Nodes& first)
    : motion_(std::move(motion)), bodies_(bodies) {
  Nodes filled = filled_in(first, *motion_);
  solution_.dimension = filled.dimension;
  solution_.times = std::move(filled.times), solution_.states = std::move(filled.states);
  solution_.complete = filled.complete;
  solution_.phases = first.phases;
}

void Judged::compare(const std::function<void(const double* state, MutableBodyColumns out)>& write,
                     const Nodes& other) {
  BodyTable here(bodies_), there(bodies_);
  for (std::size_t i = 0; i < other.times.size() && other.times[i] <= solution_.times.back(); ++i) {
    const auto t = static_cast<double>(other.times[i]);
    motion_->write(state_at(solution_, *motion_, t).data(), here.columns());
    write(&other.states[i * other.dimension], there.columns());
    const double apart = distance_between(here.columns(), there.columns());
    errors_.emplace_back(t, kSafety * apart + rounding(here.columns()));
  }
  solution_.complete = solution_.complete && other.complete;
}

ReferenceSolution Judged::solution() {
  std::sort(errors_.begin(), errors_.end());
  double largest = 0;
  for (const auto& [t, error] : errors_) {
    largest = std::max(largest, error);
    solution_.error_times.push_back(t);
    solution_.errors.push_back(largest);
  }
  return std::move(solution_);
}

}  // namespace rigor::inline truth::solving
