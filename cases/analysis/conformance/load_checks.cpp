// Forces, torques and springs, of the engine's own or as wrenches.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/analysis/conformance/trial.h"
#include "cases/truth/truth.h"
#include "core/dynamics/model/energy.h"
#include "core/engine/run_name.h"

namespace rigor::inline analysis::conformance {
namespace {

CheckResult a_force_acts_while_it_is_there(const Trial& trial) {
  const double dt = 1.0 / 64, eps = rounding_of(trial);
  const Body body = round_body();
  Scene scene = scene_of(body);
  scene.forces = {{.body = 0, .force = {3, -1, 2}, .torque = {0.6, 1.2, -1.8}, .from = 0, .until = dt}};
  if (const std::string why = why_not(trial, scene, dt); !why.empty()) return not_asked(why);
  TriedWorld world(trial, scene);
  const BodyState pushed = world.step(dt).state().columns().body(0);
  const Vec3 velocity = body.velocity + dt / body.mass * scene.forces[0].force,
             angular_velocity = body.angular_velocity + dt / 1.5 * scene.forces[0].torque;
  Comparison push(world.sent() + "; read");
  push.vector("velocity after the push", pushed.velocity, velocity, 20 * eps);
  // The body turns by w dt = 0.017 within the step. The square of that is left to the scheme.
  const double turning = 1e-3 * (angular_velocity - body.angular_velocity).norm();
  push.vector("angular velocity after the push", pushed.angular_velocity, angular_velocity, 20 * eps + turning);
  const BodyState later = world.step(dt, 10).state().columns().body(0);
  Comparison cleared(world.sent() + "; read");
  cleared.vector("velocity ten steps after it", later.velocity, velocity, 200 * eps);
  cleared.vector("angular velocity ten steps after it", later.angular_velocity, pushed.angular_velocity, 200 * eps);
  return push.result().answer == CheckResult::Answer::broken ? push.result() : cleared.result();
}

// The course's cube, hung off-centre from the world by a damped spring.
Scene hanging_cube() {
  Body cube;
  cube.name = "cube", cube.mass = 100, cube.position = {0, 0.5, 0};
  Scene scene = scene_of(cube, {0, -9.8, 0});
  scene.springs = {{.a = kWorld,
                    .b = 0,
                    .point_a = {.12, 2, .12},
                    .point_b = {.12, .12, .12},
                    .stiffness = 1e4,
                    .damping = 20,
                    .rest_length = 1.38}};
  return scene;
}

CheckResult a_spring_converges(const Trial& trial) {
  const Scene scene = hanging_cube();
  if (const std::string why = why_not(trial, scene, 1e-3); !why.empty()) return not_asked(why);
  BodyTable truth(1);
  make_truth("reference", scene, 1)->at(1, truth.columns());
  std::string sent;
  const auto error_at = [&](int steps) {
    TriedWorld world(trial, scene);
    const Vec3 came = world.step(1.0 / steps, steps).state().columns().position(0);
    sent = world.sent() + "; read";
    return (came - truth.columns().position(0)).norm();
  };
  const double coarse = error_at(500), fine = error_at(1000), rounding = 1e4 * rounding_of(trial);
  Comparison spring(sent);
  // The error of a first-order step is about dt x 3 m/s. An explicit step also grows by e^(w² dt/2), 1.4 here.
  spring.number("a distance [m] from the truth of", fine, 0, 5.0 / 1000 + rounding);
  if (spring.result().answer == CheckResult::Answer::broken) return spring.result();
  if (fine <= coarse / 1.6 + rounding) return holds();  // halving the step halves it at least: wrenches are held
  return broken(sent + "; and the same in 500 steps",
                fmt::format("{:.3g} m from the truth, and {:.3g} m", fine, coarse),
                fmt::format("at most {:.3g} m", coarse / 1.6 + rounding));
}

CheckResult a_pair_keeps_its_momentum(const Trial& trial) {
  Scene scene = scene_of(odd_body());
  Body other = round_body();
  other.name = "other", other.mass = 2, other.position += Vec3(1, 0.5, 0), other.velocity = {-0.3, 0.2, 0};
  scene.bodies.push_back(other);
  scene.springs = {{.a = 0,
                    .b = 1,
                    .point_a = {0.1, 0, 0.2},
                    .point_b = {0, 0.3, 0},
                    .stiffness = 50,
                    .damping = 0.5,
                    .rest_length = 0.8}};
  if (const std::string why = why_not(trial, scene, 1e-2); !why.empty()) return not_asked(why);
  const auto momentum = [&](const BodyTable& state) {
    return Vec3(3 * state.columns().velocity(0) + 2 * state.columns().velocity(1));
  };
  TriedWorld world(trial, scene);
  const Vec3 before = momentum(world.state()), after = momentum(world.step(1e-2, 200).state());
  Comparison kept(world.sent() + "; read");
  kept.vector("linear momentum [kg m/s]", after, before, 2e3 * rounding_of(trial));  // ten roundings a step
  return kept.result();
}

// A thousand turns of a stiff oscillator. The energy of a symplectic method oscillates and does not drift.
CheckResult symplectic_is_as_it_says(const Trial& trial) {
  if (!method_of(trial.info, trial.settings).symplectic) return not_asked("it does not say that it is symplectic");
  constexpr int kSteps = 3000, kWindow = 210;  // ten turns
  const double dt = 0.3;
  Body bob;
  bob.name = "bob", bob.position = {1.5, 0, 0};
  Scene scene = scene_of(bob);
  scene.springs = {{.a = kWorld, .b = 0, .point_a = {-1, 0, 0}, .stiffness = 1, .rest_length = 2}};
  if (const std::string why = why_not(trial, scene, dt); !why.empty()) return not_asked(why);
  TriedWorld world(trial, scene);
  double first = 0, last = 0;
  for (int n = 0; n < kWindow; ++n) first += energy(scene, world.step(dt).state().columns()) / kWindow;
  world.step(dt, kSteps - 2 * kWindow);
  for (int n = 0; n < kWindow; ++n) last += energy(scene, world.step(dt).state().columns()) / kWindow;
  // A window may hold a part of a turn more. Ten turns dilute its oscillation of 15 %.
  if (std::abs(last / first - 1) <= 0.02) return holds();
  return broken("an oscillator of 1 kg and 1 N/m, 3000 steps of 0.3 s",
                fmt::format("a mean energy of {:.4g} J at first and {:.4g} J at last", first, last),
                "the same within 2 %, of a symplectic method");
}

}  // namespace

std::vector<ConformanceCheck> load_checks() {
  return {{"wrench", "a force and a torque give their impulse, in W, and are gone after their step",
           a_force_acts_while_it_is_there},
          {"spring", "a damped spring off the centre converges to the reference", a_spring_converges},
          {"momentum", "two bodies that are tied to each other alone keep their momentum", a_pair_keeps_its_momentum},
          {"symplectic", "what says that it is symplectic keeps its energy over long runs", symplectic_is_as_it_says}};
}

}  // namespace rigor::inline analysis::conformance
