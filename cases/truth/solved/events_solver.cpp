// Solutions with steps of 1/60 s, 1/120 s, ... until two in a row agree. Both integrators are of fourth order, with
// held contacts too, so that the finer of two errs by a fifteenth of their distance between events; kSafety times the
// whole of it is said. Ways of even and odd number differ in more than the step: the integrator, and the speed below
// which nothing rebounds.
#include "cases/truth/solved/events_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cases/truth/distance.h"
#include "cases/truth/solved/pose_interpolation.h"
#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/joints/joint_stops.h"

namespace rigor {
namespace {

struct Way {
  const char* integrator;
  const char* restitution_threshold;  // m/s
};
constexpr Way kWays[] = {{"rkmk4", "2e-7"}, {"rk4", "1e-7"}};

constexpr double kFirstStep = 1.0 / 60;  // s
constexpr int kMostHalvings = 7;
constexpr double kWantedEventsError = 1e-8;  // m and rad; metrics ask for a hundred times that
constexpr double kUseful = 1e-6;             // m and rad, what metrics ask for
constexpr double kMostWork = 2e5;            // steps of a body, of some 20 µs each where it touches others
constexpr const char* kPatience = "10";      // what a run takes in inelastic steps is found event by event here
constexpr double kSafety = 3;
// What both ways have in common: gaps that count as closed [m], and speeds of separating or sliding that count as none
// [m/s]; see event.cpp and contact_modes.h.
constexpr double kClosed = 1e-10, kStill = 1e-9;

// Makes steps of one scene in one way; each begins afresh, for the state is all there is.
class Stepping {
 public:
  Stepping(const Scene& scene, const Way& way)
      : scene_(scene), system_(scene), integrator_(integrator(way.integrator)) {
    if (!integrator_.default_orientation.empty()) orientation_ = &orientation_update(integrator_.default_orientation);
    Settings settings;
    settings.method = way.integrator;
    settings.options["restitution-threshold"] = way.restitution_threshold;
    settings.options["patience"] = kPatience;
    if (!scene.joints.empty()) joints_ = std::make_unique<Joints>(scene, system_);
    if (JointStops::has_speed_motors(scene))
      motors_ = std::make_unique<JointStops>(scene, system_, system_.loads, *joints_, JointStops::Of::motors);
    stepper_ = contact_method("event").make(
        scene, {system_, integrator_, orientation_, settings, joints_.get(), motors_.get()});
  }

  BodyTable start() const {
    BodyTable state(scene_.bodies.size(), keeps_matrix());
    set_initial_state(scene_, state.columns());
    return state;
  }
  // A state for it, of the thirteen columns that a node has.
  BodyTable state_of(const double* node) const {
    BodyTable state(scene_.bodies.size(), keeps_matrix());
    for (std::size_t i = 0; i < state.size(); ++i) {
      for (int c = 0; c < kRotation; ++c) state.columns().column(c)[i] = node[c * state.size() + i];
      if (keeps_matrix()) state.columns().set_rotation(i, matrix_of(state.columns().orientation(i)));
    }
    return state;
  }
  // Returns whether the method and the joints have nothing to say against it.
  bool step(MutableBodyColumns state, double t, double dt) {
    if (joints_) joints_->begin_step();
    stepper_->step(state, t, dt);
    if (joints_) joints_->end_step(state);
    return stepper_->solver_warning().empty() && (!joints_ || joints_->warning().empty());
  }
  const ContactStepper& stepper() const { return *stepper_; }

 private:
  bool keeps_matrix() const { return orientation_ && orientation_->keeps_matrix; }

  const Scene& scene_;
  System system_;
  const Integrator& integrator_;
  const OrientationUpdate* orientation_ = nullptr;
  std::unique_ptr<Joints> joints_;      // null where there are none
  std::unique_ptr<JointStops> motors_;  // of given speed; null where there are none
  std::unique_ptr<ContactStepper> stepper_;
};

void add_node(ReferenceSolution& solution, double t, BodyColumns state) {
  solution.times.push_back(t);
  for (int c = 0; c < kRotation; ++c)
    solution.states.insert(solution.states.end(), state.column(c), state.column(c) + state.size());
  solution.states.push_back(0);
}

// Ends early where the method warns, or when the work, in steps of a body, is more than is allowed.
ReferenceSolution solve(const Scene& scene, double duration, const Way& way, double dt, double& work) {
  Stepping stepping(scene, way);
  BodyTable state = stepping.start();
  ReferenceSolution solution;
  solution.dimension = kRotation * state.size() + 1;
  add_node(solution, 0, std::as_const(state).columns());
  const auto steps = static_cast<long>(std::ceil(duration / dt - 1e-9));
  for (long n = 0; n < steps; ++n) {
    const bool is_sound = stepping.step(state.columns(), static_cast<double>(n) * dt, dt);
    work = static_cast<double>(stepping.stepper().work()) * static_cast<double>(state.size());
    if (!is_sound || work > kMostWork) return solution;
    solution.states.back() = stepping.stepper().was_smooth() ? 1 : 0;
    add_node(solution, static_cast<double>(n + 1) * dt, std::as_const(state).columns());
  }
  solution.complete = true;
  return solution;
}

// Into `fine`: its error at each of its nodes as long as `coarse` goes.
void note_errors(ReferenceSolution& fine, const ReferenceSolution& coarse, const Scene& scene) {
  fine.error_times.clear(), fine.errors.clear();
  BodyTable a(scene.bodies.size()), b(scene.bodies.size());
  double largest = 0;
  for (std::size_t i = 0; i < fine.times.size() && fine.times[i] <= coarse.times.back(); ++i) {
    const auto t = static_cast<double>(fine.times[i]);
    state_at(fine, scene, t, a.columns());
    state_at(coarse, scene, t, b.columns());
    largest = std::max(largest, distance_between(std::as_const(a).columns(), std::as_const(b).columns()));
    fine.error_times.push_back(t);
    fine.errors.push_back(kSafety * largest + kClosed + kStill * t);
  }
}

// s, until which the error is at most so much.
double reach(const ReferenceSolution& solution, double error) {
  double last = 0;
  for (std::size_t i = 0; i < solution.errors.size() && solution.errors[i] <= error; ++i)
    last = solution.error_times[i];
  return last;
}

}  // namespace

ReferenceSolution solve_events(const Scene& scene, double duration) {
  double work = 0;
  ReferenceSolution coarse = solve(scene, duration, kWays[0], kFirstStep, work), best;
  for (int k = 1; k <= kMostHalvings && work <= kMostWork; ++k) {
    ReferenceSolution fine = solve(scene, duration, kWays[k % 2], std::ldexp(kFirstStep, -k), work);
    note_errors(fine, coarse, scene);
    const double now = reach(fine, kUseful), before = reach(best, kUseful);
    const bool goes_on = fine.times.back() >= coarse.times.back();
    const bool is_better = k == 1 || now > before || (now == before && goes_on);
    // What gave up earlier says less of the next than what is there.
    if (goes_on) coarse = fine;
    if (is_better) best = std::move(fine);
    if (reach(best, kWantedEventsError + kClosed + kStill * duration) >= duration * (1 - 1e-9)) break;
  }
  return best;
}

void state_at(const ReferenceSolution& solution, const Scene& scene, double t, MutableBodyColumns out) {
  const auto next = std::upper_bound(solution.times.begin(), solution.times.end(), static_cast<long double>(t));
  const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - solution.times.begin(), 1) - 1);
  const double* node = &solution.states[i * solution.dimension];
  const double after = t - static_cast<double>(solution.times[i]);
  const std::size_t bodies = scene.bodies.size();
  const auto body = [&](const double* from, std::size_t b) {
    const BodyColumns columns(from, bodies, bodies, false);
    return columns.body(b);
  };
  const bool is_last = i + 1 == solution.times.size();
  if (is_last || !(after > 0)) {
    for (std::size_t b = 0; b < bodies; ++b) out.set_body(b, body(node, b));
    return;
  }
  const double h = static_cast<double>(solution.times[i + 1] - solution.times[i]);
  if (node[solution.dimension - 1] == 1) {
    for (std::size_t b = 0; b < bodies; ++b)
      out.set_body(b, between(body(node, b), body(node + solution.dimension, b), h, after / h));
    return;
  }
  Stepping stepping(scene, kWays[1]);
  BodyTable state = stepping.state_of(node);
  stepping.step(state.columns(), static_cast<double>(solution.times[i]), after);
  for (std::size_t b = 0; b < bodies; ++b) out.set_body(b, std::as_const(state).columns().body(b));
}

}  // namespace rigor
