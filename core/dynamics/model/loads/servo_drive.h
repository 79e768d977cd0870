// A servo at work. A method that locates events chooses its branch: saturated or not, and the effort that it holds
// between samples. Between two such choices the law is smooth. Without such a method, the effort follows the clamped
// law at each evaluation, and sample() is called before each step.
#pragma once

#include <limits>
#include <optional>

#include "core/scene/drives.h"

namespace rigor::inline dynamics {

class ServoDrive {
 public:
  // `turns`: of an angle that is known up to whole turns.
  ServoDrive(const Motor& motor, bool turns) : motor_(motor), turns_(turns) {}

  // Within a part of a step [t, t + dt]; `instant` as in JointDrive::effort().
  double effort(double x, double rate, double t, double dt, std::optional<double> instant) const;
  // Samples, where a sample is due at t.
  void sample(double x, double rate, double t);
  // From now on the branch is the one that choose_branch() took last.
  void locate_events() { locates_events_ = true; }
  void choose_branch(double x, double rate, double t);
  // How far the law is from a change of branch [N m, N], below zero until it happens, and its rate [N m/s, N/s].
  struct Distance {
    double value = -std::numeric_limits<double>::infinity(), rate = 0;
  };
  Distance to_change(double x, double rate, double acceleration, double t) const;

  double period() const { return servo().period; }
  bool damps() const { return servo().period == 0 && servo().kd != 0; }
  double next_sample(double t, double end) const;
  double next_switch(double t, double end) const { return motor_.next_switch(t, end); }

  template <typename Archive>
  void archive_state(Archive& archive) {
    archive(side_, held_, last_sample_);
  }

 private:
  const Servo& servo() const { return *motor_.servo; }
  double unbounded(double x, double rate, double t) const { return servo().unbounded(x, rate, t, turns_); }

  Motor motor_;
  bool turns_, locates_events_ = false;
  int side_ = 0;             // saturated at -most or most, or not at all
  double held_ = 0;          // N m, N: since its last sample
  double last_sample_ = -1;  // its number
};

}  // namespace rigor::inline dynamics
