#include "core/dynamics/integrators/joint_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

constexpr int kMostEvents = 1000;         // in a step
constexpr std::size_t kMostAtOnce = 4;    // at one instant, for each limit and motor
constexpr double kTimeTolerance = 1e-15;  // of a step, to which events are located
// As a share of a step: shorter bounces are suppressed. From a drop over one step, ten bounces with e = 0.5 precede
// such a bounce. It would rise 1e-7 of what gravity moves a body in a step.
constexpr double kShortestFlight = 1e-3;

}  // namespace

JointEvents::JointEvents(const Scene& scene, System& system, Joints& joints, std::unique_ptr<Stepper> inner)
    : joints_(joints),
      stops_(scene, system, system.loads, joints),
      inner_(std::move(inner)),
      start_(system.size()),
      trial_(system.size()) {}

void JointEvents::step(MutableBodyColumns state, double t, double dt) {
  solver_warning_.clear();
  if (!(dt > 0)) {
    inner_->step(state, t, dt);
    return warn("limits of joints, servos and motors of a given speed cannot be run back in time");
  }
  whole_step_ = dt;
  stops_.read(state, 0);
  double done = 0;
  std::size_t at_once = 0;
  for (int events = 0; done < dt; ++events) {
    const double now = t + done;
    if (!stops_.settle(state, now, kShortestFlight * dt))
      warn("it could not be decided which limits and motors of the joints hold");
    if (events == kMostEvents || at_once > kMostAtOnce * (1 + stops_.size())) {
      inner_->step(state, now, dt - done);
      stops_.read(state, dt - done);
      return warn(fmt::format("limits and motors of the joints changed {} times in one {}",
                              events == kMostEvents ? events : static_cast<int>(at_once),
                              events == kMostEvents ? "step" : "instant"));
    }
    const double until = stops_.next_switch(now, t + dt);
    const double way = advance(state, now, until < t + dt ? until - now : dt - done);
    done += way;
    at_once = way > 0 ? 0 : at_once + 1;
  }
}

double JointEvents::advance(MutableBodyColumns state, double t, double h) {
  start_ = BodyColumns(state);
  noted_ = joints_.noted();
  attempt(t, h);
  for (std::size_t stop = 0; stop < stops_.size(); ++stop) {
    for (const auto event : JointStops::kEvents) {
      if (!(stops_.distance_to(stop, event) >= 0) && !stops_.may_have_touched(stop, event, h)) continue;
      h = time_of(stop, event, t, h);
      attempt(t, h);  // the others are asked at the first of all that were found
    }
  }
  if (solver_warning_.empty()) solver_warning_ = inner_->solver_warning();
  copy_columns(trial_.columns(), state);
  return h;
}

void JointEvents::attempt(double t, double h) {
  joints_.note_only(noted_);
  trial_ = start_.columns();
  if (h > 0) {
    inner_->step(trial_.columns(), t, h);
    // Of a method whose velocities belong elsewhere in its step, closing a gap of 1e-13 m within a short part of one
    // would make a speed.
    if (h < whole_step_) joints_.push(joints_.velocity_impulse(trial_.columns()), trial_.columns());
    stops_.read(trial_.columns(), h);
  } else {
    stops_.read_settled();
  }
  if (stops_.needs_efforts()) stops_.note_efforts(trial_.columns(), t + h);
}

double JointEvents::time_of(std::size_t stop, JointStops::Event event, double t, double h) {
  const auto distance = [&](double at) {
    attempt(t, at);
    return stops_.distance_to(stop, event);
  };
  if (stops_.distance_to(stop, event) >= 0) return root(distance, h, stops_.distance_to(stop, event));
  const double sign = stops_.rate(stop, event) > 0 ? 1 : -1;
  const double turns = root([&](double at) { return attempt(t, at), sign * stops_.rate(stop, event); }, h,
                            sign * stops_.rate(stop, event));
  const double at_turn = distance(turns);
  return at_turn < 0 ? h : root(distance, turns, at_turn);
}

template <typename Function>
double JointEvents::root(const Function& f, double h, double at_end) const {
  const double at_start = f(0);
  if (at_start >= 0) return 0;
  if (!(at_start < 0 && at_end >= 0)) return h;  // not a number: a diverged motion continues unchanged
  std::uintmax_t most = 100;
  const auto near = [h](double a, double b) { return std::abs(b - a) <= kTimeTolerance * h; };
  return boost::math::tools::toms748_solve(f, 0.0, h, at_start, at_end, near, most).second;
}

void JointEvents::archive_state(StateArchive& archive) {
  archive(stops_, solver_warning_);
  inner_->archive_state(archive);
}

void JointEvents::warn(const std::string& what) {
  if (solver_warning_.empty()) solver_warning_ = what;
}

}  // namespace rigor::inline dynamics
