// The changes of joint limits and of motors that keep a speed at an instant (core/scene/scene.h):
//   a limit x <= upper   takes an effort of at most 0, and none where x < upper; what hits it leaves with x' = -e x'
//   a motor              keeps x' = speed as long as |effort| <= most, and else pushes by `most` towards it
// Several at once form a linear complementarity problem, for impulses at an impact and for efforts after it. Both are
// solved by changing the first violated one until none is (Murty, Opsearch 11, 1974). Written apart from core/dynamics
// on purpose. A coordinate that comes to rest at a limit would bounce infinitely often. A bounce shorter than twice
// `rest_time` is therefore suppressed, with an error of a rest_time² / 2, where a is the acceleration.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cases/truth/solved/jointed/axis_drive.h"
#include "cases/truth/solved/jointed/axis_rows.h"
#include "cases/truth/solved/jointed/joint_axis.h"

namespace rigor::inline truth::solving {

inline constexpr double kTouch = 1e-11;     // rad, m: an event's time is located to a thousandth of that
inline constexpr double kSameSpeed = 1e-9;  // rad/s, m/s
inline constexpr double kStill = 1e-11;     // rad/s, m/s: rounding of a kept coordinate
inline constexpr double kNoShare = 1e-9;    // of the largest effort: rounding of zero
// Also a share of the largest joint load by the weight of all bodies, because no effort is large in free fall. A limit
// that holds with this excess gives an acceleration error of 1e-13 g.
inline constexpr double kNoShareOfWeight = 1e-13;

template <typename Motion>
class Stops {
 public:
  using State = typename Motion::State;
  using Real = typename State::value_type;
  using Values = std::vector<AxisMotion<Real>>;

  Stops(const Motion& motion, double rest_time)
      : motion_(motion),
        rest_time_(rest_time),
        least_effort_(kNoShareOfWeight * effort_of_weight(motion.scene())),
        modes_(motion.axes().size()) {}

  static bool are_in(const Scene& scene) {
    return std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& j) { return j.has_limits(); }) ||
           std::any_of(scene.motors.begin(), scene.motors.end(), [](const Motor& m) { return m.speed || m.servo; });
  }

  const AxisModes& modes() const { return modes_; }
  double no_effort() const { return no_effort_; }  // rounding of zero [N m, N]
  const Joint& joint(std::size_t k) const { return motion_.scene().joints[motion_.axes()[k].joint]; }
  // Positive by as much as x is beyond the limit of that side.
  Real beyond(std::size_t k, int side, const Real& x) const {
    return side > 0 ? Real(x - static_cast<Real>(joint(k).upper)) : Real(static_cast<Real>(joint(k).lower) - x);
  }

  // Impacts at t change the state's velocities; then modes() are those from t on, while loads are those of `during`.
  // False if that cannot be decided.
  bool settle(State& state, double t, double during) {
    modes_.assign(modes_.size(), {});
    touched_.assign(modes_.size(), 0);
    const Values before = interval(state, during).axes_at(state);
    bool is_hit = false;
    for (std::size_t k = 0; k < modes_.size(); ++k) {
      for (const int side : {1, -1}) {
        if (beyond(k, side, before[k].x) >= -kTouch) touched_[k] = side;
      }
      is_hit |= touched_[k] * before[k].rate > kStill;
    }
    if (is_hit && !strike(state, before, during)) return false;
    const Values struck = interval(state, during).axes_at(state);
    sample_servos(state, struck, t, during);
    guess_motors(struck, during);
    saturate_servos(state, t, during);
    Interval free = interval(state, during);
    guess_limits(look(free, state, t));
    return find_modes(state, t, during);
  }

 private:
  using Interval = typename Motion::Interval;

  Interval interval(const State& state, double during) const {
    return motion_.during(during, modes_, motion_.choice_at(state, modes_));
  }
  static Values look(Interval& interval, const State& state, double t) {
    State change;
    interval(state, change, static_cast<Real>(t));
    return interval.axes_at(state);
  }
  std::size_t most_changes() const { return 16 * (1 + modes_.size()); }

  // Impulses on the limits that are hit: each limit keeps a row, or its sign is wrong and it has none.
  bool strike(State& state, const Values& before, double during) {
    for (std::size_t k = 0; k < modes_.size(); ++k) {
      if (touched_[k] * before[k].rate > kStill) modes_[k].limit = touched_[k];
    }
    for (std::size_t n = 0; n < most_changes(); ++n) {
      for (std::size_t k = 0; k < modes_.size(); ++k) {
        const Real approach = touched_[k] * before[k].rate;
        modes_[k].bounce = approach > 0 ? static_cast<long double>(-joint(k).restitution * before[k].rate) : 0;
      }
      State after = state;
      Interval impact = interval(state, during);
      if (!impact.project_rates(after)) return false;
      const Values at = impact.axes_at(after);
      const Real none = kNoShare * largest_effort(at);
      const std::size_t wrong = first_wrong([&](std::size_t k) {
        return modes_[k].limit != 0 ? modes_[k].limit * at[k].effort > none : touched_[k] * at[k].rate > kStill;
      });
      if (wrong == modes_.size()) {
        state = after;
        modes_.assign(modes_.size(), {});
        return true;
      }
      modes_[wrong].limit = modes_[wrong].limit != 0 ? 0 : touched_[wrong];
    }
    return false;
  }

  // All that may hold does.
  void guess_motors(const Values& at, double during) {
    for (std::size_t k = 0; k < modes_.size(); ++k) {
      const Motor* const motor = motor_at(k, during);
      if (!motor) continue;
      AxisMode& mode = modes_[k];
      mode.speed = *motor->speed, mode.most = motor->most;
      const double behind = mode.speed - static_cast<double>(at[k].rate);
      mode.keeps_speed = std::abs(behind) <= kSameSpeed;
      if (!mode.keeps_speed) mode.push = behind > 0 ? 1 : -1;
    }
  }
  void guess_limits(const Values& at) {
    for (std::size_t k = 0; k < modes_.size(); ++k) {
      if (!rests(touched_[k], at[k])) continue;
      modes_[k].limit = touched_[k];
      stop_keeping(modes_[k]);
    }
  }
  // A motor cannot keep its speed at an active limit. It pushes with its largest effort, or its speed equals the
  // limit's.
  static void stop_keeping(AxisMode& mode) {
    if (!mode.keeps_speed) return;
    mode.keeps_speed = false;
    mode.push = mode.speed > 0 ? 1 : mode.speed < 0 ? -1 : 0;
  }
  bool rests(int side, const AxisMotion<Real>& at) const {
    const double speed = std::abs(static_cast<double>(at.rate)), back = static_cast<double>(side * at.acceleration);
    return side != 0 && (speed <= kStill || speed <= rest_time_ * back);
  }

  const Joint& joint_of(std::size_t k) const { return motion_.scene().joints[motion_.axes()[k].joint]; }

  // Fills in what a continuous servo asks for at t.
 public:
  void add_servos(Values& at, const Real& t, double during) const {
    for (std::size_t k = 0; k < at.size(); ++k) {
      const Motor* const motor = servo_at(motion_.scene(), motion_.axes()[k].joint, during);
      if (!motor || motor->servo->period > 0) continue;
      const ServoLaw<Real> law(*motor->servo, takes_the_shorter_way(joint_of(k)), during);
      at[k].servo = law.effort(at[k].x, at[k].rate, t);
      at[k].servo_change = law.change(at[k].rate, at[k].acceleration);
    }
  }
  // The bound of an axis's continuous servo; infinite if it has none.
  double most_of_servo(std::size_t k, double during) const {
    const Motor* const motor = servo_at(motion_.scene(), motion_.axes()[k].joint, during);
    return motor && motor->servo->period == 0 ? motor->servo->most : std::numeric_limits<double>::infinity();
  }

 private:
  // Holds new efforts where a sample is due at t.
  void sample_servos(State& state, const Values& at, double t, double during) {
    for (std::size_t k = 0; k < modes_.size(); ++k) {
      const Motor* const motor = servo_at(motion_.scene(), motion_.axes()[k].joint, during);
      if (!motor || motor->servo->period == 0) continue;
      const double periods = (t - motor->from) / motor->servo->period;
      constexpr double kSameInstant = 1e-9;  // of a period
      if (std::abs(periods - std::round(periods)) > kSameInstant) continue;
      const ServoLaw<Real> law(*motor->servo, takes_the_shorter_way(joint_of(k)), during);
      const Real most = static_cast<Real>(motor->servo->most);
      state[motion_.clock_place() + 1 + k] =
          std::clamp<Real>(law.effort(at[k].x, at[k].rate, static_cast<Real>(t)), -most, most);
    }
  }
  // At its bound, a servo is saturated if it goes beyond it.
  void saturate_servos(const State& state, double t, double during) {
    Interval free = interval(state, during);
    Values at = look(free, state, t);
    add_servos(at, static_cast<Real>(t), during);
    for (std::size_t k = 0; k < modes_.size(); ++k) {
      const double most = most_of_servo(k, during);
      if (!std::isfinite(most)) continue;
      const int side = at[k].servo > 0 ? 1 : -1;
      const double beyond = static_cast<double>(side * at[k].servo) - most;
      constexpr double kAtBound = 1e-12;  // of the bound
      const bool leaves = static_cast<double>(side * at[k].servo_change) > 0;
      modes_[k].saturated = beyond > kAtBound * most || (beyond > -kAtBound * most && leaves) ? side : 0;
    }
  }

  // If two motors drive one joint, the later one in the scene counts, as everywhere.
  const Motor* motor_at(std::size_t k, double t) const {
    const Motor* found = nullptr;
    for (const Motor& motor : motion_.scene().motors) {
      const bool acts = motor.speed && t >= motor.from && t < motor.until;
      if (acts && static_cast<std::size_t>(motor.joint) == motion_.axes()[k].joint) found = &motor;
    }
    return found;
  }

  bool find_modes(State& state, double t, double during) {
    for (std::size_t n = 0; n < most_changes(); ++n) {
      State held = state;
      Interval here = interval(state, during);
      if (!here.project_rates(held)) return false;
      const Values at = look(here, held, t);
      no_effort_ = std::max(least_effort_, kNoShare * static_cast<double>(largest_effort(at)));
      const std::size_t wrong = first_wrong([&](std::size_t k) { return is_wrong(modes_[k], touched_[k], at[k]); });
      if (wrong == modes_.size()) {
        state = held;
        return true;
      }
      change_mode(modes_[wrong], touched_[wrong], at[wrong]);
    }
    return false;
  }

  bool is_wrong(const AxisMode& mode, int side, const AxisMotion<Real>& at) const {
    // Half of the tolerance that locates an event; the ended mode is wrong after it.
    if (mode.limit != 0) return mode.limit * at.effort > no_effort_ / 2;
    if (mode.keeps_speed) return std::abs(static_cast<double>(at.effort)) > mode.most + no_effort_ / 2;
    if (side * at.acceleration > kSameSpeed && rests(side, at)) return true;
    return is_at_speed(mode, at) && mode.push * at.acceleration > kSameSpeed;
  }
  static bool is_at_speed(const AxisMode& mode, const AxisMotion<Real>& at) {
    return mode.push != 0 && std::abs(static_cast<double>(at.rate) - mode.speed) <= kSameSpeed;
  }

  static void change_mode(AxisMode& mode, int side, const AxisMotion<Real>& at) {
    if (mode.limit != 0) {
      mode.limit = 0;
    } else if (mode.keeps_speed) {
      mode.keeps_speed = false, mode.push = at.effort > 0 ? 1 : -1;
    } else if (is_at_speed(mode, at)) {
      mode.push = 0, mode.keeps_speed = true;
    } else {
      mode.limit = side;
    }
  }

  // N, or N m on the longest arm that there is, if that is more than a metre.
  static double effort_of_weight(const Scene& scene) {
    double mass = 0, arm = 1;
    for (const Body& body : scene.bodies) {
      if (!body.fixed) mass += body.mass;
      for (const Body& other : scene.bodies) arm = std::max(arm, (body.position - other.position).norm());
    }
    return mass * scene.gravity.norm() * arm;
  }

  template <typename IsWrong>
  std::size_t first_wrong(const IsWrong& is_wrong) const {
    std::size_t k = 0;
    while (k < modes_.size() && !is_wrong(k)) ++k;
    return k;
  }

  static Real largest_effort(const Values& at) {
    Real largest = 0;
    for (const AxisMotion<Real>& axis : at)
      largest = std::max<Real>(largest, axis.effort < 0 ? -axis.effort : axis.effort);
    return largest;
  }

  const Motion& motion_;
  double rest_time_;     // s
  double least_effort_;  // rounding of zero without loads
  double no_effort_ = 0;
  AxisModes modes_;
  std::vector<int> touched_;  // of each axis: the limit at which it is, or 0
};

}  // namespace rigor::inline truth::solving
