// Motion of free bodies, compared with closed forms and the reference.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/analysis/conformance/trial.h"
#include "cases/truth/truth.h"
#include "core/engine/run_name.h"
#include "core/scene/turned.h"

namespace rigor::inline analysis::conformance {
namespace {

BodyState truth_at(const Scene& scene, double t) {
  BodyTable table(scene.bodies.size());
  make_truth("reference", scene, t)->at(t, table.columns());
  return table.columns().body(0);
}

const MethodInfo& method_of(const Trial& trial) { return rigor::method_of(trial.info, trial.settings); }

CheckResult a_ball_goes_straight(const Trial& trial) {
  const Body body = round_body();
  const double dt = 1e-2, t = 1, eps = rounding_of(trial);
  TriedWorld world(trial, scene_of(body));
  const BodyState came = world.step(dt, 100).state().columns().body(0);
  Comparison straight(world.sent() + "; read");
  // A hundred roundings of numbers of about 5, and of a few stages in each step.
  straight.vector("velocity", came.velocity, body.velocity, 1e3 * eps);
  straight.vector("angular velocity", came.angular_velocity, body.angular_velocity, 1e3 * eps);
  straight.vector("position", came.position, body.position + t * body.velocity, 1e3 * eps);
  // The crudest update turns by atan(w dt) in a step.
  const double w = body.angular_velocity.norm(), lag = w * w * w * dt * dt / 3 * t;
  straight.orientation(came.orientation, rotation_by(body.angular_velocity * t) * body.orientation, lag + 1e3 * eps);
  return straight.result();
}

CheckResult it_neither_sleeps_nor_damps(const Trial& trial) {
  if (trial.settings.track != Track::matched) return not_asked("as shipped it may");
  Body slow = round_body();
  slow.velocity = {1e-3, 0, 0}, slow.angular_velocity = {0, 1e-3, 0};
  TriedWorld world(trial, scene_of(slow));
  const BodyState came = world.step(1.0 / 60, 300).state().columns().body(0);
  Comparison even(world.sent() + "; read");
  const double rounding = 300 * rounding_of(trial) * 1e-3;
  even.vector("velocity", came.velocity, slow.velocity, rounding);
  even.vector("angular velocity", came.angular_velocity, slow.angular_velocity, 10 * rounding);
  return even.result();
}

// A semi-implicit step falls g dt t / 2 too far, and an explicit step as much too short. Others are nearer.
CheckResult it_falls_as_its_order_says(const Trial& trial) {
  const double dt = 1.0 / 30, t = 1, eps = rounding_of(trial);
  const Scene scene = scene_of(round_body(), {3, -2, -9});
  TriedWorld world(trial, scene);
  const Vec3 came = world.step(dt, 30).state().columns().position(0);
  const Body& start = scene.bodies[0];
  const Vec3 parabola = start.position + t * start.velocity + 0.5 * t * t * scene.gravity,
             half_step = 0.5 * dt * t * scene.gravity;
  Comparison fall(world.sent() + "; read");
  const double rounding = 300 * eps;  // thirty steps of numbers of about 10
  const MethodInfo& method = method_of(trial);
  if (method.leapfrog_stagger == 0.5) {
    fall.vector("position", came, parabola + half_step, rounding);
  } else if (method.order >= 2) {
    fall.vector("position", came, parabola, rounding);
  } else {
    fall.vector("position", came, parabola, half_step.norm() + rounding);
  }
  return fall.result();
}

struct OrderFound {
  double coarse, fine;  // errors
  std::string sent;
};

// The error after so many steps of dt [rad, rad/s].
double error_of_top(const Trial& trial, const Body& body, double dt, int steps, std::string& sent) {
  const Scene scene = scene_of(body);
  const BodyState truth = truth_at(scene, dt * steps);
  TriedWorld world(trial, scene);
  const BodyState came = world.step(dt, steps).state().columns().body(0);
  sent = world.sent();
  return std::max(angle_between(came.orientation, truth.orientation),
                  (came.angular_velocity - truth.angular_velocity).norm());
}

OrderFound errors_of_top(const Trial& trial, int steps) {
  OrderFound found{0, 0, ""};
  found.coarse = error_of_top(trial, odd_body(), 1.0 / steps, steps, found.sent);
  found.fine = error_of_top(trial, odd_body(), 0.5 / steps, 2 * steps, found.sent);
  return found;
}

// An adaptive method divides a step of half a turn until the error is small. A method that only claims to be adaptive
// has a large error here; no other check asks for its order.
CheckResult an_adaptive_top_needs_no_short_steps(const Trial& trial) {
  constexpr double kLongStep = 3;  // s, at some 1 rad/s
  // A tolerance of a thousandth, as some engines ship, gives 0.04. One undivided step gives 0.14 to 3, except for
  // compositions of exact rotations, which are as accurate as the loosest adaptive method.
  constexpr double kMost = 0.1;
  std::string sent;
  Body uneven = odd_body();
  uneven.inertia(0, 0) = 1;  // nearly alike moments are turned well by one step, too
  const double error = error_of_top(trial, uneven, kLongStep, 1, sent);
  Comparison top(sent + "; read; of a method that says it is adaptive");
  top.number("an error [rad, rad/s] of", error, 0, kMost);
  return top.result();
}

CheckResult a_top_turns_as_its_order_says(const Trial& trial) {
  constexpr int kSteps = 100;
  const OrderFound found = errors_of_top(trial, kSteps);
  const double rounding = 20 * kSteps * rounding_of(trial);  // ten of numbers of about 1 for each step of the longer
  // A missing gyroscopic term or a wrong frame of w makes an error near w² t in a second. The error of a first-order
  // step is w² dt.
  constexpr double kFirstOrder = 2.0 / kSteps;
  Comparison top(found.sent + "; read");
  top.number("an error [rad, rad/s] of", found.coarse, 0, kFirstOrder + rounding);
  if (top.result().answer == CheckResult::Answer::broken) return top.result();
  if (method_of(trial).adaptive) return an_adaptive_top_needs_no_short_steps(trial);
  // Halving the step divides the error by 2^order, less a tenth for the next term.
  const double due = found.coarse / (0.8 * std::pow(2, method_of(trial).order)) + rounding;
  if (found.fine <= due) return holds();
  return broken(found.sent + fmt::format("; read; and the same in {} steps", kSteps),
                fmt::format("errors of {:.3g} and, at half the step, {:.3g}", found.coarse, found.fine),
                fmt::format("at most {:.3g} at half the step: order {}", due, method_of(trial).order));
}

CheckResult a_turned_world_turns_the_motion(const Trial& trial) {
  const Scene scene = scene_of(odd_body(), {1, 2, -9.81});
  const Quat turn = rotation_by({0.7, -1.1, 0.4});
  const BodyState here = TriedWorld(trial, scene).step(1.0 / 120, 120).state().columns().body(0);
  TriedWorld world(trial, turned(scene, turn));
  const BodyState there = world.step(1.0 / 120, 120).state().columns().body(0);
  // A rounding of numbers of about 10 for each step, which a second of tumbling magnifies by no more than some ten.
  const double rounding = 120 * 100 * rounding_of(trial);
  Comparison same(world.sent() + "; read; the same scene as before, in a world turned about");
  same.vector("position", there.position, turn * here.position, rounding);
  same.vector("velocity", there.velocity, turn * here.velocity, rounding);
  same.vector("angular velocity", there.angular_velocity, turn * here.angular_velocity, rounding);
  same.orientation(there.orientation, turn * here.orientation, rounding);
  return same.result();
}

}  // namespace

std::vector<ConformanceCheck> motion_checks() {
  return {{"straight-line", "without forces a ball goes straight and turns evenly", a_ball_goes_straight},
          {"no-sleep", "on the track 'matched' a slow body neither sleeps nor is damped", it_neither_sleeps_nor_damps},
          {"free-fall", "it falls along the parabola, as near as its order says", it_falls_as_its_order_says},
          {"spin", "a free body of any inertia turns by Euler's equations, as near as its order says",
           a_top_turns_as_its_order_says},
          {"turned-frame", "a scene turned about moves in the same way", a_turned_world_turns_the_motion}};
}

}  // namespace rigor::inline analysis::conformance
