// The motion of any smooth scene, solved twice in extended precision: by Fehlberg's Runge-Kutta pair of order 8(7) with
// body rates, and by Gragg-Bulirsch-Stoer extrapolation with angular momenta, at a looser tolerance (Hairer, Nørsett,
// Wanner, Solving Ordinary Differential Equations I, sections II.5 and II.9). The first is the truth; how far the
// second is from it is its error. Both go from one switch of a timed force to the next, so that no step straddles a
// jump. Between two nodes the state is one step of order 8 from the earlier one: there is no interpolation error.
#include <fmt/format.h>

#include <algorithm>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "cases/truth/equations_of_motion.h"
#include "cases/truth/truth.h"
#include "core/error.h"
#include "core/scene/features.h"

namespace rigor {
namespace {

namespace odeint = boost::numeric::odeint;

using Real = long double;
using State = std::vector<Real>;

// Relative and absolute, per step: some ten and twenty roundings of a long double. Extrapolation magnifies roundings,
// so that below that its steps would shrink without end.
constexpr Real kTolerance = 1e-18L, kSecondTolerance = 2e-18L;
constexpr Real kFirstStep = 1e-4L;  // s
constexpr std::size_t kMostTries = 2'000'000;
constexpr double kMostBytes = 512e6;  // of nodes

// The accepted steps of one solution, rounded to double.
struct Nodes {
  std::vector<Real> times;     // s
  std::vector<double> states;  // `dimension` numbers each
  std::size_t dimension = 0;
  bool complete = false;  // reaches the end; if not, the motion was not smooth there

  void add(Real t, const State& state) {
    times.push_back(t);
    for (const Real number : state) states.push_back(static_cast<double>(number));
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

bool finite(const State& state) {
  return std::all_of(state.begin(), state.end(), [](Real number) { return std::isfinite(number); });
}

// Steps from `begin` to `end`; false if it cannot get there.
template <typename Stepper, typename System>
bool solve_interval(Stepper stepper, System& system, Real begin, Real end, State& state, Nodes& nodes) {
  Real t = begin, h = std::min(kFirstStep, end - begin);
  for (std::size_t tries = 0; t < end; ++tries) {
    const bool is_last = h >= end - t;
    if (is_last) h = end - t;
    if (t + h == t || tries == kMostTries || nodes.states.size() * sizeof(double) > kMostBytes) return false;
    if (stepper.try_step(std::ref(system), state, t, h) == odeint::fail) continue;
    if (!finite(state)) return false;
    if (is_last) t = end;
    nodes.add(t, state);
  }
  return true;
}

template <typename Stepper>
Nodes solve(const EquationsOfMotion<Real>& motion, const Stepper& stepper, const std::vector<double>& switches) {
  State state = motion.start();
  Nodes nodes;
  nodes.dimension = state.size();
  nodes.add(0, state);
  for (std::size_t i = 0; i + 1 < switches.size(); ++i) {
    auto system = motion.during(0.5 * (switches[i] + switches[i + 1]));
    if (!solve_interval(stepper, system, switches[i], switches[i + 1], state, nodes)) return nodes;
  }
  nodes.complete = true;
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

class Reference final : public Truth {
 public:
  Reference(const Scene& scene, double duration) : bodies_(scene.bodies.size()), motion_(scene, kTruthsForm) {
    const std::vector<double> switches = switch_times(scene, duration);
    const EquationsOfMotion<Real> motion(scene, kTruthsForm), second_motion(scene, Formulation::momentum);
    nodes_ = solve(
        motion,
        odeint::make_controlled(kTolerance, kTolerance, odeint::runge_kutta_fehlberg78<State, Real, State, Real>()),
        switches);
    estimate_error(
        second_motion,
        solve(second_motion, odeint::bulirsch_stoer<State, Real, State, Real>(kSecondTolerance, kSecondTolerance),
              switches));
  }

  void at(double t, MutableBodyColumns out) const override {
    const auto after = std::upper_bound(nodes_.times.begin(), nodes_.times.end(), static_cast<Real>(t));
    const std::size_t node = after == nodes_.times.begin() ? 0 : after - nodes_.times.begin() - 1;
    const auto first = nodes_.states.begin() + node * nodes_.dimension;
    std::vector<double> state(first, first + nodes_.dimension);
    const bool is_beyond = after == nodes_.times.end();
    const double h = is_beyond ? 0 : static_cast<double>(t - nodes_.times[node]);
    if (h > 0) {
      auto system = motion_.during(static_cast<double>(0.5L * (nodes_.times[node] + *after)));
      odeint::runge_kutta_fehlberg78<std::vector<double>>().do_step(std::ref(system), state, 0.0, h);
    }
    motion_.write(state.data(), out);
  }

  double error(double t) const override {
    const auto next = std::lower_bound(error_times_.begin(), error_times_.end(), t);
    if (next == error_times_.end()) return complete_ ? errors_.back() : std::numeric_limits<double>::infinity();
    return errors_[next - error_times_.begin()];
  }

 private:
  static constexpr Formulation kTruthsForm = Formulation::body_rates;

  void estimate_error(const EquationsOfMotion<Real>& second_motion, const Nodes& second) {
    BodyTable here(bodies_), there(bodies_);
    double largest = 0;
    for (std::size_t i = 0; i < second.times.size() && second.times[i] <= nodes_.times.back(); ++i) {
      const double t = static_cast<double>(second.times[i]);
      at(t, here.columns());
      second_motion.write(&second.states[i * second.dimension], there.columns());
      largest = std::max(largest, distance(here.columns(), there.columns()) + rounding(here.columns()));
      error_times_.push_back(t);
      errors_.push_back(largest);
    }
    complete_ = nodes_.complete && second.complete;
  }

  std::size_t bodies_;
  EquationsOfMotion<double> motion_;  // for the step from a node
  Nodes nodes_;
  std::vector<double> error_times_, errors_;  // s; the running maximum up to each
  bool complete_ = false;
};

std::unique_ptr<Truth> make_reference(const Scene& scene, double duration) {
  for (const Need& need : needs_of(scene)) {
    if (need.feature == "fixed-body" || need.feature == "spring" || need.feature == "timed-force") continue;
    throw InputError(
        fmt::format("the truth 'reference' is for smooth scenes, without contacts and joints; this one has {}: {}",
                    need.feature, need.because));
  }
  return std::make_unique<Reference>(scene, duration);
}

}  // namespace

TruthRow reference_truth() {
  return {"reference", "any smooth scene, solved twice in extended precision: the difference is its error",
          make_reference};
}

}  // namespace rigor
