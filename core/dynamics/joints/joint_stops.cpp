#include "core/dynamics/joints/joint_stops.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/joints/joint_limits.h"
#include "core/dynamics/model/contact_scales.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

// In the coordinate's unit and the scene's unit of time (contact_scales.h).
constexpr double kTouch = 1e-11;      // from so near a limit on it is reached
constexpr double kAtRest = 1e-9;      // a slower coordinate, or smaller deviation from a motor's speed, is at rest
constexpr double kLeaves = 1e-5;      // faster than the velocity from closing a gap of kTouch
constexpr double kNoFlight = 4e-11;   // a coordinate that would rise no higher off its limit stays there
constexpr double kNoChange = 1e-9;    // an acceleration that rounding can make
constexpr double kNoEffort = 1e-9;    // of the largest force: ten thousand times what rounding leaves of one
constexpr int kMostChangesEach = 16;  // of a coordinate's mode in the search for which hold

// m or rad. Roundings of a slider's coordinate grow with its limits.
double unit_of(const Joint& joint, double length) {
  if (turns(joint)) return 1;
  for (const double limit : {joint.lower, joint.upper}) {
    if (std::isfinite(limit)) length = std::max(length, std::abs(limit));
  }
  return length;
}

// The law of a servo without a bound, which acts always, towards one target, is the same at all times.
bool has_events_of_servo(const Motor& motor) {
  if (!motor.servo) return false;
  const Servo& servo = *motor.servo;
  return servo.period > 0 || std::isfinite(servo.most) || !servo.target.is_constant() || motor.from > 0 ||
         std::isfinite(motor.until);
}
bool has_events_of_servos(const Scene& scene, int joint) {
  return std::any_of(scene.motors.begin(), scene.motors.end(), [joint](const Motor& motor) {
    return motor.joint == joint && motor.plus.empty() && has_events_of_servo(motor);
  });
}

}  // namespace

JointStops::JointStops(const Scene& scene, const System& system, Loads& loads, Joints& joints, Of what)
    : joints_(joints), loads_(loads), wrenches_(system) {
  const ContactScales scales = contact_scales(scene);
  time_unit_ = scales.time;
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    const Joint& joint = scene.joints[k];
    std::vector<Motor> motors;
    for (const Motor& motor : scene.motors) {
      if (motor.joint == static_cast<int>(k) && motor.speed) motors.push_back(motor);
    }
    const bool has_limits = joint.has_limits() && what == Of::limits_and_motors;
    const bool has_events = what == Of::limits_and_motors && has_events_of_servos(scene, static_cast<int>(k));
    std::vector<ServoDrive>* const servos = has_events ? loads.servos_of(k) : nullptr;
    if (!has_limits && motors.empty() && !servos) continue;
    constexpr double kNone = std::numeric_limits<double>::infinity();
    stops_.push_back({k, JointCoordinate(scene, joint), has_limits ? joint.lower : -kNone,
                      has_limits ? joint.upper : kNone, joint.restitution, motors, unit_of(joint, scales.length),
                      servos});
    if (!servos) continue;
    for (ServoDrive& servo : *servos) servo.locate_events();
  }
}

bool JointStops::are_in(const Scene& scene) {
  return has_speed_motors(scene) || std::any_of(scene.motors.begin(), scene.motors.end(), has_events_of_servo) ||
         std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) { return joint.has_limits(); });
}

bool JointStops::has_speed_motors(const Scene& scene) {
  return std::any_of(scene.motors.begin(), scene.motors.end(),
                     [](const Motor& motor) { return motor.speed.has_value(); });
}

bool JointStops::has_servos(const Scene& scene) {
  return std::any_of(scene.motors.begin(), scene.motors.end(),
                     [](const Motor& motor) { return motor.servo.has_value(); });
}

void JointStops::read(BodyColumns state, double since) {
  now_ = settled_at_ + since;
  for (Stop& stop : stops_) {
    const JointCoordinate::Value at = stop.coordinate.at(state);
    const double expected = since == 0 ? stop.x : stop.settled_x + 0.5 * since * (stop.settled_rate + at.rate);
    stop.x = stop.coordinate.with_turns(at.x, expected), stop.rate = at.rate;
  }
}

void JointStops::read_settled() {
  now_ = settled_at_;
  for (Stop& stop : stops_)
    stop.x = stop.settled_x, stop.rate = stop.settled_rate, stop.acceleration = stop.settled_acceleration;
}

// Rows and pushes are among the joints' and the loads' own state.
void JointStops::archive_state(StateArchive& archive) {
  archive(no_force_, settled_at_, now_);
  archive.each(stops_, [&](Stop& stop) {
    archive(stop.x, stop.rate, stop.settled_x, stop.settled_rate, stop.acceleration, stop.settled_acceleration,
            stop.effort, stop.at, stop.drive, stop.push, stop.bounce);
    archive.place_in(stop.motors, stop.motor);
  });
}

double JointStops::next_switch(double t, double end) const {
  for (const Stop& stop : stops_) {
    for (const Motor& motor : stop.motors) end = motor.next_switch(t, end);
    if (!stop.servos) continue;
    for (const ServoDrive& servo : *stop.servos) end = servo.next_switch(t, end);
  }
  return end;
}

// Positive by as much as x is beyond the limit of that side.
double JointStops::Stop::touched(int side) const { return side > 0 ? x - upper : lower - x; }
double JointStops::at_rest(const Stop& stop) const { return kAtRest * stop.unit / time_unit_; }
double JointStops::no_change(const Stop& stop) const { return kNoChange * stop.unit / (time_unit_ * time_unit_); }
double JointStops::as_effort(const Stop& stop, double force) const {
  return stop.coordinate.turns() ? force * joints_.size() : force;
}
double JointStops::no_effort(const Stop& stop) const { return as_effort(stop, no_force_); }
bool JointStops::touches(const Stop& stop, int side) const { return stop.touched(side) >= -kTouch * stop.unit; }
bool JointStops::is_hit(const Stop& stop, int side) const {
  return touches(stop, side) && side * stop.rate > at_rest(stop);
}
int JointStops::hit_side(const Stop& stop) const { return is_hit(stop, 1) ? 1 : is_hit(stop, -1) ? -1 : 0; }

bool JointStops::settle(MutableBodyColumns state, double t, double shortest_flight) {
  choose_motors(t);
  bool decided = resolve_impacts(state, t, shortest_flight);
  settled_at_ = now_ = t;
  for (Stop& stop : stops_) {
    if (!stop.servos) continue;
    for (ServoDrive& servo : *stop.servos) servo.choose_branch(stop.x, stop.rate, t);
  }
  guess_modes();
  decided = find_modes(state, loads_at(state, t)) && decided;
  for (Stop& stop : stops_) {
    if (stop.servos) stop.acceleration = joints_.coordinate_acceleration(stop.joint, state);
    stop.settled_x = stop.x, stop.settled_rate = stop.rate, stop.settled_acceleration = stop.acceleration;
  }
  return decided;
}

ServoDrive::Distance JointStops::servo_distance(const Stop& stop, double x, double rate, double acceleration,
                                                double t) const {
  ServoDrive::Distance nearest;
  for (const ServoDrive& servo : *stop.servos) {
    const ServoDrive::Distance distance = servo.to_change(x, rate, acceleration, t);
    if (distance.value > nearest.value) nearest = distance;
  }
  return nearest;
}

double JointStops::rate(std::size_t i, Event event) const {
  const Stop& stop = stops_[i];
  if (event != Event::servo) return stop.rate;
  return servo_distance(stop, stop.x, stop.rate, stop.acceleration, now_).rate;
}

void JointStops::let_go(BodyColumns state) {
  for (Stop& stop : stops_) stop.drive = Drive::off;
  apply(state);
}

bool JointStops::settle_motors(BodyColumns state, double t, const Wrench& wrench) {
  choose_motors(t);
  read(state, 0);
  guess_modes();
  const bool decided = find_modes(state, wrench);
  for (Stop& stop : stops_) stop.settled_x = stop.x, stop.settled_rate = stop.rate;
  return decided;
}

void JointStops::choose_motors(double t) {
  for (Stop& stop : stops_) {
    stop.motor = nullptr;
    for (const Motor& motor : stop.motors) {
      if (t >= motor.from && t < motor.until) stop.motor = &motor;
    }
  }
}

// Hands the rows and pushes as they are now to the joints and the loads.
void JointStops::apply(BodyColumns state) {
  for (const Stop& stop : stops_) {
    const bool keeps = stop.drive == Drive::keeping && stop.at == 0;
    const CoordinateRow row = stop.at != 0 ? CoordinateRow::kept : keeps ? CoordinateRow::driven : CoordinateRow::none;
    const double target = stop.at > 0 ? stop.upper : stop.at < 0 ? stop.lower : stop.x;
    joints_.set_coordinate(stop.joint, row, target, keeps ? *stop.motor->speed : stop.bounce);
    if (!stop.motors.empty()) loads_.set_push(stop.joint, stop.drive == Drive::pushing ? stop.push : 0);
  }
  joints_.count_rows(state);
}

JointStops::Wrench JointStops::loads_at(BodyColumns state, double t) {
  return [this, state, t] { return wrenches_.over_step(state, t, 0); };
}

void JointStops::hold(BodyColumns state, const double* wrench) {
  joints_.hold(state, wrench, Joints::Rows::chosen_anew);
  for (Stop& stop : stops_) stop.effort = joints_.coordinate_effort(stop.joint);
  no_force_ = kNoEffort * joints_.largest_force();
}

bool JointStops::resolve_impacts(MutableBodyColumns state, double t, double shortest_flight) {
  std::vector<int> hit;  // side by stop
  for (const Stop& stop : stops_) hit.push_back(hit_side(stop));
  if (std::none_of(hit.begin(), hit.end(), [](int side) { return side != 0; })) return true;
  for (std::size_t i = 0; i < stops_.size(); ++i)
    stops_[i].bounce = hit[i] != 0 ? -stops_[i].restitution * stops_[i].rate : 0;
  before_ = BodyColumns(state);
  bool found = true;
  do {
    copy_columns(before_.columns(), state);
    // No motor has an impulse, for its effort has a bound.
    for (std::size_t i = 0; i < stops_.size(); ++i) stops_[i].at = hit[i], stops_[i].drive = Drive::off;
    found = find_impulses(state);
    read(state, 0);
  } while (found && take_away_short_flights(state, t, shortest_flight, hit));
  for (Stop& stop : stops_) stop.bounce = 0;
  return found;
}

// A bounce may end at once because of other constraints that hold after the impact. Returns whether there were any.
bool JointStops::take_away_short_flights(BodyColumns state, double t, double shortest_flight,
                                         const std::vector<int>& hit) {
  if (std::none_of(stops_.begin(), stops_.end(), [](const Stop& stop) { return stop.bounce != 0; })) return false;
  guess_modes();
  find_modes(state, loads_at(state, t));
  bool any = false;
  for (std::size_t i = 0; i < stops_.size(); ++i) {
    Stop& stop = stops_[i];
    if (stop.bounce == 0) continue;
    const double back = hit[i] * joints_.coordinate_acceleration(stop.joint, state);
    if (!(back > 0 && 2 * std::abs(stop.bounce) < back * shortest_flight)) continue;
    stop.bounce = 0, any = true;
  }
  return any;
}

bool JointStops::find_impulses(MutableBodyColumns state) {
  for (std::size_t n = 0; n < kMostChangesEach * (1 + stops_.size()); ++n) {
    apply(state);
    after_ = BodyColumns(state);
    joints_.push(joints_.velocity_impulse(state), after_.columns());
    const double none = kNoEffort * joints_.largest_force();
    const auto violated = std::find_if(stops_.begin(), stops_.end(), [&](Stop& stop) {
      if (stop.at != 0) return stop.at * joints_.coordinate_effort(stop.joint) > as_effort(stop, none);
      const double rate = stop.coordinate.at(after_.columns()).rate;
      const double rest = at_rest(stop);
      return (touches(stop, 1) && rate > rest) || (touches(stop, -1) && rate < -rest);
    });
    if (violated == stops_.end()) {
      copy_columns(after_.columns(), state);
      return true;
    }
    violated->at = violated->at != 0 ? 0 : touches(*violated, 1) ? 1 : -1;
  }
  return false;
}

// Constraints that held stay active. A motor that has its speed, or may reach it, keeps it.
void JointStops::guess_modes() {
  for (Stop& stop : stops_) {
    if (stop.at != 0 && !touches(stop, stop.at)) stop.at = 0;
    if (stop.at != 0 && std::abs(stop.rate) > kLeaves * stop.unit / time_unit_) stop.at = 0;
    if (!stop.motor) {
      stop.drive = Drive::off;
      continue;
    }
    const double behind = *stop.motor->speed - stop.rate;
    if (std::abs(behind) > at_rest(stop)) {
      stop.drive = Drive::pushing, stop.push = std::copysign(stop.motor->most, behind);
    } else if (stop.drive == Drive::off) {
      stop.drive = Drive::keeping;
    } else if (stop.drive == Drive::pushing) {
      stop.push = std::copysign(stop.motor->most, stop.push);
    }
  }
}

bool JointStops::find_modes(BodyColumns state, const Wrench& wrench) {
  for (std::size_t n = 0; n < kMostChangesEach * (1 + stops_.size()); ++n) {
    apply(state);
    hold(state, wrench());
    const bool changed =
        std::any_of(stops_.begin(), stops_.end(), [&](Stop& stop) { return change_if_violated(stop, state); });
    if (!changed) return true;
  }
  return false;
}

bool JointStops::change_if_violated(Stop& stop, BodyColumns state) {
  if (stop.at != 0) {
    if (stop.at * stop.effort <= 0.5 * no_effort(stop)) return false;
    stop.at = 0;
    return true;
  }
  if (stop.drive == Drive::keeping) {
    if (std::abs(stop.effort) <= stop.motor->most + 0.5 * no_effort(stop)) return false;
    stop.drive = Drive::pushing, stop.push = std::copysign(stop.motor->most, stop.effort);
    return true;
  }
  const double acceleration = joints_.coordinate_acceleration(stop.joint, state), rest = at_rest(stop);
  for (const int side : {1, -1}) {
    const double back = side * acceleration, away = -side * stop.rate;
    if (touches(stop, side) && back > no_change(stop) && away >= -rest &&
        (away <= rest || away * away <= 2 * back * kNoFlight * stop.unit)) {
      stop.at = side;
      return true;
    }
  }
  const bool has_speed = stop.drive == Drive::pushing && std::abs(*stop.motor->speed - stop.rate) <= rest;
  if (has_speed && std::copysign(1, stop.push) * acceleration > no_change(stop)) {
    stop.drive = Drive::keeping;
    return true;
  }
  return false;
}

double JointStops::distance_to(std::size_t i, Event event) const {
  const Stop& stop = stops_[i];
  if (event == Event::servo)
    return stop.servos ? servo_distance(stop, stop.x, stop.rate, stop.acceleration, now_).value : -1;
  if (event == Event::motor) {
    if (stop.drive == Drive::keeping && stop.at == 0) return std::abs(stop.effort) - stop.motor->most - no_effort(stop);
    if (stop.drive != Drive::pushing) return -1;
    const double to = *stop.motor->speed - stop.settled_rate;
    // A motor that has its speed and still pushes is saturated. It must first leave that speed.
    const double rest = at_rest(stop);
    if (std::abs(to) <= rest) return std::copysign(1, stop.push) * (stop.rate - *stop.motor->speed) - 2 * rest;
    return std::copysign(1, to) * (stop.rate - *stop.motor->speed);
  }
  const int side = event == Event::upper ? 1 : -1;
  if (stop.at == side) return side * stop.effort - no_effort(stop);
  if (stop.at != 0) return -1;
  // After a bounce the coordinate must go further than it was before it counts as reaching the limit again.
  const double at_start = side > 0 ? stop.settled_x - stop.upper : stop.lower - stop.settled_x;
  const double touch = kTouch * stop.unit;
  return stop.touched(side) - (at_start >= -touch ? std::max(0.0, at_start) + 2 * touch : 0);
}

bool JointStops::may_have_touched(std::size_t i, Event event, double since) const {
  const Stop& stop = stops_[i];
  if (event == Event::servo) {
    if (!stop.servos) return false;
    const ServoDrive::Distance before = servo_distance(stop, stop.settled_x, stop.settled_rate,
                                                       stop.settled_acceleration, settled_at_),
                               after = servo_distance(stop, stop.x, stop.rate, stop.acceleration, now_);
    return std::isfinite(before.value) && std::isfinite(after.value) && before.rate > 0 && after.rate < 0 &&
           peak_between(before.value, before.rate, after.value, after.rate, since) > 0;
  }
  if (event == Event::motor || stop.at != 0) return false;
  const double side = event == Event::upper ? 1 : -1, limit = event == Event::upper ? stop.upper : stop.lower;
  const double peak =
      peak_between(side * stop.settled_x, side * stop.settled_rate, side * stop.x, side * stop.rate, since);
  return peak > side * limit;
}

bool JointStops::needs_efforts() const {
  return std::any_of(stops_.begin(), stops_.end(),
                     [](const Stop& stop) { return stop.at != 0 || stop.drive == Drive::keeping || stop.servos; });
}

void JointStops::note_efforts(BodyColumns state, double t) { note_efforts(state, wrenches_.over_step(state, t, 0)); }

void JointStops::note_efforts(BodyColumns state, const double* wrench) {
  const double no_force = no_force_;
  hold(state, wrench);
  no_force_ = no_force;  // one for a whole step: events are roots against it
  for (Stop& stop : stops_) {
    if (stop.servos) stop.acceleration = joints_.coordinate_acceleration(stop.joint, state);
  }
}

double JointStops::margin_of_motors() const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < stops_.size(); ++i) least = std::min(least, -distance_to(i, Event::motor));
  return least;
}

}  // namespace rigor::inline dynamics
