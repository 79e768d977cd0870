// Soft contact against the closed form of a bounce on a spring and damper without gravity: with z = c/(2 sqrt(k m)) the
// contact lasts 2 acos(z)/(w0 sqrt(1 - z²)), and the speed after is exp(-2 z acos(z)/sqrt(1 - z²)) of that before.
#include <cmath>

#include "core/dynamics/model/energy.h"
#include "core/engine/engine_failure.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_soft_soft)

namespace {

constexpr double kSpringRate = 1e4;

double bounce_of(double damping, double mass) {
  const double z = damping / (2 * std::sqrt(kSpringRate * mass));
  return std::exp(-2 * z * std::acos(z) / std::sqrt(1 - z * z));
}

Scene ball_before_wall(double damping) {
  Scene scene =
      on_floor({solid("ball", Sphere{0.1}, {0, 0, 0.2})}, {.stiffness = kSpringRate, .damping = damping}, Vec3::Zero());
  scene.bodies[0].velocity = {0.3, 0, -2};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_ball_leaves_a_wall_with_the_speed_of_the_closed_form) {
  for (const double damping : {0.0, 10.0, 60.0, 150.0}) {
    ContactRun run(ball_before_wall(damping), "soft", "dormand-prince");
    run.run(1.0 / 30, 10);
    // Its tolerance of 1e-12 is met around the jump of the force, where each step loses about as much.
    BOOST_TEST(std::abs(run.state().velocity(0).z() - 2 * bounce_of(damping, 1)) < 1e-9, damping);
    BOOST_TEST(std::abs(run.state().velocity(0).x() - 0.3) < 1e-15);
  }
}

// Methods of fixed step meet the force somewhere in their steps, and come nearer with the step.
BOOST_AUTO_TEST_CASE(methods_of_fixed_step_converge_to_it) {
  for (const char* integrator : {"explicit-euler", "velocity-verlet", "rk4", "rkmk4"}) {
    double last = 1;
    for (const int steps : {200, 2000, 20000}) {
      ContactRun run(ball_before_wall(60), "soft", integrator);
      run.run(0.3 / steps, steps);
      const double error = std::abs(run.state().velocity(0).z() - 2 * bounce_of(60, 1));
      BOOST_TEST(error < 0.3 * last, integrator << " with " << steps << " steps");
      last = error;
    }
    BOOST_TEST(last < 5e-3, integrator);
  }
}

// Without gravity d v - ln(1 + d v) is the same before and after (Hunt and Crossley).
BOOST_AUTO_TEST_CASE(a_ball_leaves_a_wall_by_hunt_and_crossleys_law) {
  for (const double dissipation : {0.05, 0.3}) {
    Scene scene = ball_before_wall(0);
    scene.contact_default.dissipation = dissipation;
    ContactRun run(scene, "soft", "dormand-prince");
    run.run(1.0 / 30, 12);
    const auto kept = [&](double v) { return dissipation * v - std::log1p(dissipation * v); };
    BOOST_TEST(run.state().velocity(0).z() > 0.5);
    BOOST_TEST(std::abs(kept(-run.state().velocity(0).z()) - kept(2)) < 1e-9, dissipation);
  }
}

// The reduced mass of two equal balls is half of one's.
BOOST_AUTO_TEST_CASE(two_balls_keep_their_momentum) {
  Scene scene;
  scene.bodies = {solid("a", Sphere{0.1}, {0, 0, 0}), solid("b", Sphere{0.1}, {0.25, 0.05, 0})};
  scene.bodies[0].velocity = {2, 0.4, 0};
  scene.contact_default = {.stiffness = kSpringRate, .damping = 40};
  ContactRun run(scene, "soft", "dormand-prince");
  run.run(1.0 / 30, 10);
  BOOST_TEST((run.state().velocity(0) + run.state().velocity(1) - scene.bodies[0].velocity).norm() < 1e-12);
  BOOST_TEST(run.state().velocity(1).x() > 0.5);

  scene.bodies[1].position = {0.25, 0, 0}, scene.bodies[0].velocity = {2, 0, 0};
  ContactRun head_on(scene, "soft", "dormand-prince");
  head_on.run(1.0 / 30, 10);
  const double parting = head_on.state().velocity(1).x() - head_on.state().velocity(0).x();
  BOOST_TEST(std::abs(parting - 2 * bounce_of(40, 0.5)) < 1e-9);
}

BOOST_AUTO_TEST_CASE(fast_balls_do_not_pass_through_each_other_between_stages) {
  Scene scene;
  scene.bodies = {solid("a", Sphere{0.1}, {0, 0, 0}), solid("b", Sphere{0.1}, {5, 0, 0})};
  scene.bodies[0].velocity = {300, 0, 0};
  scene.contact_default = {.stiffness = 1e8};
  ContactRun run(scene, "soft", "rk4");
  run.run(1.0 / 30, 2);
  BOOST_TEST(run.state().velocity(1).x() > 290);
}

BOOST_AUTO_TEST_CASE(a_rigid_pair_is_refused) {
  Scene scene = ball_before_wall(0);
  scene.bodies.push_back(solid("other", Sphere{0.1}, {3, 0, 0.2}));
  scene.contact_pairs = {{0, 2, {.restitution = 1}}};
  BOOST_CHECK_THROW(ContactRun(scene, "soft", "rk4"), EngineFailure);
}

BOOST_AUTO_TEST_SUITE_END()
