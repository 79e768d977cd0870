// What motors and servos give a joint's coordinate between two switches, for any number type. There each table is a
// straight line, and a servo is saturated, holds its last sample, or is linear. Written apart from core/dynamics on
// purpose. The state of a motion with efforts in time or servos ends with a clock [s] and, for each axis, the effort
// that its servo holds [N m or N].
#pragma once

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "cases/truth/solved/jointed/axis_modes.h"
#include "core/scene/scene.h"
#include "core/scene/turn_window.h"

namespace rigor::inline truth {

// Whether states have a clock and held efforts.
inline bool has_clock(const Scene& scene) {
  return std::any_of(scene.motors.begin(), scene.motors.end(),
                     [](const Motor& motor) { return motor.efforts || motor.servo; });
}
inline std::size_t clock_numbers(const Scene& scene, std::size_t axes) { return has_clock(scene) ? 1 + axes : 0; }

// The servo that acts on a joint at t; null if none does.
inline const Motor* servo_at(const Scene& scene, std::size_t joint, double t) {
  for (const Motor& motor : scene.motors) {
    if (motor.servo && motor.plus.empty() && static_cast<std::size_t>(motor.joint) == joint && t >= motor.from &&
        t < motor.until)
      return &motor;
  }
  return nullptr;
}

// The straight piece of a table in which an instant lies.
template <typename Real>
struct StraightPiece {
  Real start = 0, value = 0, slope = 0;

  StraightPiece(const TimeTable& table, double within) {
    std::size_t next = 0;
    while (next < table.times.size() && table.times[next] <= within) ++next;
    const std::size_t k = next > 0 ? next - 1 : 0;
    start = static_cast<Real>(table.times[k]), value = static_cast<Real>(table.values[k]);
    if (!table.is_linear || next == 0 || next == table.times.size()) return;
    slope = (static_cast<Real>(table.values[next]) - value) / (static_cast<Real>(table.times[next]) - start);
  }
  Real at(const Real& t) const { return value + slope * (t - start); }
};

// A servo's law before its bound, and how fast that changes.
template <typename Real>
class ServoLaw {
 public:
  ServoLaw(const Servo& servo, bool turns, double within)
      : servo_(&servo), turns_(turns), target_(servo.target, within) {}

  Real effort(const Real& x, const Real& rate, const Real& t) const {
    using std::round;
    Real behind = target_.at(t) - x;
    const Real turn = 2 * boost::math::constants::pi<Real>();
    if (turns_) behind -= turn * round(behind / turn);
    return static_cast<Real>(servo_->kp) * behind +
           static_cast<Real>(servo_->kd) * (static_cast<Real>(servo_->target_speed) - rate);
  }
  Real change(const Real& rate, const Real& acceleration) const {
    return static_cast<Real>(servo_->kp) * (target_.slope - rate) - static_cast<Real>(servo_->kd) * acceleration;
  }

 private:
  const Servo* servo_;
  bool turns_;
  StraightPiece<Real> target_;
};

template <typename Real>
class AxisDrive {
 public:
  // `within`: an instant of the interval in which nothing switches.
  AxisDrive(const Scene& scene, std::size_t joint, double within, const AxisMode& mode)
      : constant_(static_cast<Real>(mode.push * mode.most)) {
    for (const Motor& motor : scene.motors) {
      if (static_cast<std::size_t>(motor.joint) != joint || !motor.gives_effort() || !(within >= motor.from) ||
          !(within < motor.until))
        continue;
      if (motor.efforts)
        pieces_.emplace_back(*motor.efforts, within);
      else
        constant_ += static_cast<Real>(motor.effort);
    }
    const Motor* const motor = servo_at(scene, joint, within);
    if (!motor) return;
    if (motor->servo->period > 0) {
      holds_ = true;
    } else if (mode.saturated != 0) {
      constant_ += static_cast<Real>(mode.saturated * motor->servo->most);
    } else {
      law_.emplace(*motor->servo, takes_the_shorter_way(scene.joints[joint]), within);
    }
  }

  // `clock`: the numbers of has_clock(), of which that at 1 + axis is this axis's; null if there are none.
  Real effort(const Real& x, const Real& rate, const Real* clock, std::size_t axis) const {
    Real sum = constant_;
    for (const StraightPiece<Real>& piece : pieces_) sum += piece.at(clock[0]);
    if (holds_) sum += clock[1 + axis];
    if (law_) sum += law_->effort(x, rate, clock[0]);
    return sum;
  }

 private:
  Real constant_;
  std::vector<StraightPiece<Real>> pieces_;
  bool holds_ = false;
  std::optional<ServoLaw<Real>> law_;
};

}  // namespace rigor::inline truth
