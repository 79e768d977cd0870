// The solution of a scene with limits or motors that keep a speed: smooth from one event to the next. An event is a
// root of a function of the coordinates' motion. It is located by repeating its step with other lengths:
//   a servo reaches its bound or leaves it               the effort beyond that, and its rate
//   a limit is reached, or a motor comes to its speed    its distance, and its rate, which say whether it turned
//   between a limit lets go, or a motor can keep its speed no more    the effort beyond what it may be
#pragma once

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cases/truth/solved/jointed/stops.h"
#include "cases/truth/solved/solving.h"

namespace rigor::inline truth::solving {

template <typename Motion, typename Stepper>
class StoppedSolution {
 public:
  StoppedSolution(const Motion& motion, Stepper stepper, double rest_time)
      : motion_(motion), stepper_(std::move(stepper)), stops_(motion, rest_time), state_(motion.start()) {}

  Nodes solve(const std::vector<double>& switches) {
    nodes_.dimension = state_.size();
    for (std::size_t i = 0; i + 1 < switches.size(); ++i) {
      if (!solve_until(switches[i + 1], (switches[i] + switches[i + 1]) / 2)) return std::move(nodes_);
    }
    nodes_.complete = true;
    return std::move(nodes_);
  }

 private:
  using State = typename Motion::State;
  using Real = typename State::value_type;
  using Interval = typename Motion::Interval;
  using Values = std::vector<AxisMotion<Real>>;

  bool solve_until(Real end, double during) {
    constexpr int kMostEvents = 20'000;
    for (int events = 0; t_ < end; ++events) {
      if (events == kMostEvents || !stops_.settle(state_, static_cast<double>(t_), during)) return false;
      note_phase();
      if (!go_on(end, during)) return false;
    }
    return true;
  }

  void note_phase() {
    nodes_.phases.times.push_back(static_cast<Extended>(t_));
    const std::vector<double> numbers = numbers_of(stops_.modes());
    nodes_.phases.modes.insert(nodes_.phases.modes.end(), numbers.begin(), numbers.end());
    nodes_.add(static_cast<Extended>(t_), state_);
  }

  // To the next event, or to `end`.
  bool go_on(Real end, double during) {
    during_ = during;
    Interval interval = motion_.during(during, stops_.modes(), motion_.choice_at(state_, stops_.modes()));
    while (t_ < end) {
      start_ = state_, from_ = t_;
      if (nodes_.is_full() || !step_towards(stepper_, interval, t_, end, h_, state_, tries_left_)) return false;
      const Real whole = t_ - from_;
      const Real until = first_event(interval, whole);
      if (!(until > 0 && until <= whole)) return false;  // not valid for the settled state
      const bool is_cut = until < whole;
      if (is_cut) state_ = state_after(interval, until), t_ = from_ + until;
      nodes_.add(static_cast<Extended>(t_), state_);
      if (is_cut) return true;
    }
    return true;
  }

  State state_after(Interval& interval, Real h) {
    if (!(h > 0)) return start_;
    State state = stepper_.after(interval, start_, from_, h);
    interval.project(state);
    return state;
  }
  Values values_at(Interval& interval, const State& state, Real t) const {
    State change;
    interval(state, change, t);
    Values values = interval.axes_at(state);
    stops_.add_servos(values, t, during_);
    return values;
  }

  // The function that becomes positive at an event, and its rate; nothing if the event cannot occur.
  struct Watch {
    std::size_t axis;
    enum class Kind { reach_limit, leave_limit, reach_speed, lose_speed, reach_bound, leave_bound } kind;
    int side = 0;
  };

  std::vector<Watch> watches() const {
    using Kind = typename Watch::Kind;
    std::vector<Watch> all;
    for (std::size_t k = 0; k < stops_.modes().size(); ++k) {
      const AxisMode& mode = stops_.modes()[k];
      if (mode.saturated != 0) all.push_back({k, Kind::leave_bound, mode.saturated});
      for (const int side : {1, -1}) {
        if (mode.saturated == 0 && std::isfinite(stops_.most_of_servo(k, during_)))
          all.push_back({k, Kind::reach_bound, side});
      }
      if (mode.limit != 0) {
        all.push_back({k, Kind::leave_limit, mode.limit});
        continue;
      }
      for (const int side : {1, -1}) {
        if (std::isfinite(side > 0 ? stops_.joint(k).upper : stops_.joint(k).lower))
          all.push_back({k, Kind::reach_limit, side});
      }
      if (mode.keeps_speed) all.push_back({k, Kind::lose_speed});
      if (mode.push != 0) all.push_back({k, Kind::reach_speed, mode.push});
    }
    return all;
  }

  Real value(const Watch& watch, const Values& at) const {
    using Kind = typename Watch::Kind;
    const AxisMotion<Real>& axis = at[watch.axis];
    const AxisMode& mode = stops_.modes()[watch.axis];
    const Real effort = axis.effort;
    switch (watch.kind) {
      case Kind::reach_limit:
        return stops_.beyond(watch.axis, watch.side, axis.x);
      case Kind::leave_limit:
        return watch.side * effort - static_cast<Real>(stops_.no_effort());
      case Kind::reach_speed:
        return watch.side * (axis.rate - static_cast<Real>(mode.speed));
      case Kind::reach_bound:
        return watch.side * axis.servo - static_cast<Real>(stops_.most_of_servo(watch.axis, during_));
      case Kind::leave_bound:
        return static_cast<Real>(stops_.most_of_servo(watch.axis, during_)) - watch.side * axis.servo;
      case Kind::lose_speed:
        break;
    }
    return (effort < 0 ? -effort : effort) - static_cast<Real>(mode.most + stops_.no_effort());
  }
  std::optional<Real> rate(const Watch& watch, const Values& at) const {
    using Kind = typename Watch::Kind;
    if (watch.kind == Kind::reach_limit) return watch.side * at[watch.axis].rate;
    if (watch.kind == Kind::reach_bound) return watch.side * at[watch.axis].servo_change;
    if (watch.kind == Kind::leave_bound) return -watch.side * at[watch.axis].servo_change;
    if (watch.kind == Kind::reach_speed) return watch.side * at[watch.axis].acceleration;
    return std::nullopt;
  }

  // The time after from_, in [0, whole], of the first event of all; `whole` if there is none.
  Real first_event(Interval& interval, Real whole) {
    const Values before = values_at(interval, start_, from_);
    Values after = values_at(interval, state_, t_);
    Real first = whole;
    for (const Watch& watch : watches()) {
      const Real found = event_of(watch, interval, before, after, first);
      if (!(found < first)) continue;
      first = found;
      after = values_at(interval, state_after(interval, first), from_ + first);
    }
    return first;
  }

  Real event_of(const Watch& watch, Interval& interval, const Values& before, const Values& after, Real end) {
    const auto at = [&](Real h) { return values_at(interval, state_after(interval, h), from_ + h); };
    const auto f = [&](Real h) { return value(watch, at(h)); };
    const Real f0 = value(watch, before), f1 = value(watch, after);
    const std::optional<Real> d0 = rate(watch, before), d1 = rate(watch, after);
    if (f0 < -kTouch || !d0) {
      if (f1 >= 0) return f0 < 0 ? root(f, Real(0), end, f0, f1) : Real(0);
      if (!d0 || !(*d0 > 0 && *d1 < 0)) return end;
      // It has come nearer and gone again.
      const Real turn = root([&](Real h) { return -*rate(watch, at(h)); }, Real(0), end, -*d0, -*d1), peak = f(turn);
      return peak >= 0 ? root(f, Real(0), turn, f0, peak) : end;
    }
    // It begins there and leaves; it is reached if it has turned and come back.
    if (!(f1 >= 0 && *d1 > 0)) return end;
    const Real leaving = std::min<Real>(*d0, -std::numeric_limits<Real>::min());
    const Real turn = root([&](Real h) { return *rate(watch, at(h)); }, Real(0), end, leaving, *d1), low = f(turn);
    return low < 0 ? root(f, turn, end, low, f1) : Real(0);
  }

  // Of a function that is below zero at a and not at b; on b's side.
  template <typename Function>
  static Real root(const Function& f, Real a, Real b, Real at_a, Real at_b) {
    if (at_b == 0) return b;
    std::uintmax_t most = 200;
    const auto near = [b](Real low, Real high) { return high - low <= 4 * std::numeric_limits<Real>::epsilon() * b; };
    return boost::math::tools::toms748_solve(f, a, b, at_a, at_b, near, most).second;
  }

  const Motion& motion_;
  Stepper stepper_;
  Stops<Motion> stops_;
  State state_, start_;  // now, and where the step at hand began
  Real t_ = 0, from_ = 0, h_ = kFirstStep;
  double during_ = 0;  // s: an instant of the interval at hand, in which nothing switches
  std::size_t tries_left_ = kMostTries;
  Nodes nodes_;
};

// The smooth pieces of such a solution, for motions between its nodes.
template <typename Motion>
class PhasedMotion {
 public:
  using State = typename Motion::State;
  using Interval = typename Motion::Interval;

  // `Solution`: a ReferenceSolution or its Nodes.
  template <typename Solution>
  PhasedMotion(const Scene& scene, const Solution& solution)
      : motion_(scene),
        is_uniform_(solution.phases.times.empty() &&
                    switch_times(scene, std::numeric_limits<double>::infinity()).size() == 2) {
    const std::size_t phases = solution.phases.times.size(),
                      width = phases > 0 ? solution.phases.modes.size() / phases : 0;
    for (std::size_t i = 0; i < phases; ++i) {
      const Extended from = solution.phases.times[i];
      const auto node =
          std::upper_bound(solution.times.begin(), solution.times.end(), from) - solution.times.begin() - 1;
      const auto first = solution.states.begin() + node * static_cast<std::ptrdiff_t>(solution.dimension);
      const AxisModes modes = modes_of(&solution.phases.modes[i * width], width / kNumbersPerMode);
      const State state(first, first + static_cast<std::ptrdiff_t>(solution.dimension));
      phases_.push_back({from, modes, motion_.choice_at(state, modes)});
    }
  }

  // Whether during() is the same for all t.
  bool is_uniform() const { return is_uniform_; }
  Interval during(double t) const {
    const auto next = std::find_if(phases_.begin(), phases_.end(), [t](const Phase& phase) { return phase.from > t; });
    if (next == phases_.begin()) return motion_.during(t);
    return motion_.during(t, std::prev(next)->modes, std::prev(next)->choice);
  }
  template <typename Number>
  void write(const Number* state, MutableBodyColumns out) const {
    motion_.write(state, out);
  }

 private:
  struct Phase {
    Extended from;  // s
    AxisModes modes;
    RowChoice choice;
  };
  Motion motion_;
  bool is_uniform_;
  std::vector<Phase> phases_;
};

}  // namespace rigor::inline truth::solving
