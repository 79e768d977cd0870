// What drives a joint's coordinate x: efforts, speeds and servos, each while from <= t < until.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace rigor::inline scene {

// A function of time. Before its first time it has its first value, after its last time its last value.
struct TimeTable {
  std::vector<double> times, values;  // s, rising; as many values
  bool is_linear = true;              // between two times; else a value holds until the next time

  static TimeTable constant(double value) { return {{0}, {value}, false}; }
  bool is_constant() const { return times.size() == 1; }
  double at(double t) const;
  double rate(double t) const;                // of the piece that begins at t or before
  double mean(double from, double to) const;  // at(from) if the two are equal
  // Extends the piece in which `within` lies to any t.
  double extended(double within, double t) const { return at(within) + rate(within) * (t - within); }
  // The first of its times strictly between t and `end`, which may lie before t; `end` if there is none.
  double next_time(double t, double end) const;
};

// effort = clamp(kp (target - x) + kd (target_speed - x'), -most, most). For a hinge, target - x is taken from -pi to
// pi, unless its limits are less than a turn apart (turn_window.h).
struct Servo {
  TimeTable target;                                       // rad, m
  double kp = 0, kd = 0;                                  // N m/rad and N m s/rad, N/m and N s/m
  double target_speed = 0;                                // rad/s, m/s
  double most = std::numeric_limits<double>::infinity();  // N m, N
  double period = 0;  // s: it samples x and x' and holds its effort in between; 0: continuous

  double unbounded(double x, double rate, double t, bool turns) const;
  double bounded(double effort) const { return effort < -most ? -most : effort > most ? most : effort; }
};

// A joint's coordinate in a sum of several, times a factor.
struct JointTerm {
  int joint = 0;     // of Scene::joints, with a coordinate
  double ratio = 1;  // rad or m of the sum for each rad or m of the joint
};

// Acts on a hinge's angle or a slider's displacement while from <= t < until: by a given effort, by the effort that
// keeps a given speed, or as a servo. A servo may act on a sum of coordinates: its joint's, and the terms of `plus`.
// Its effort on a term's coordinate is `ratio` times that on its joint's. Such a servo is continuous, without a bound.
struct Motor {
  int joint;                                               // index
  double effort = 0;                                       // N m, N: on b along the axis, the opposite on a
  std::optional<TimeTable> efforts = {};                   // N m, N: in place of `effort`
  std::optional<double> speed = {};                        // rad/s, m/s: kept instead, with an effort of at most `most`
  double most = 0;                                         // N m, N
  double from = 0;                                         // s
  double until = std::numeric_limits<double>::infinity();  // s
  std::optional<Servo> servo = {};
  bool is_friction = false;  // Coulomb friction of the joint: keeps the speed 0 with at most `most`
  std::vector<JointTerm> plus = {};

  bool gives_effort() const { return !speed && !servo; }
  bool drives(int other) const;  // a joint, alone or in its sum
  bool acts(double t) const { return from <= t && t < until; }
  // The mean effort over the step from t to t + dt, which may go backward; at dt = 0, the effort at t.
  // `instant`: the effort at that time of a step in which next_switch() has nothing, instead of the mean.
  double mean_effort(double t, double dt, std::optional<double> instant = {}) const;
  // The first instant strictly between t and `end` at which it begins, ends or turns a corner; `end` if there is none.
  double next_switch(double t, double end) const;
  // The number of the servo's last sample at t or before, counted from `from`. An instant within a share of 1e-9 of the
  // period counts as the sample's own.
  double sample_at(double t) const { return std::floor((t - from) / servo->period + 1e-9); }
};

}  // namespace rigor::inline scene
