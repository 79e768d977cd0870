// Rolling and torsional friction of the method `impulse` against Newton's law for a ball: a couple of d N slows a ball
// that rolls by g d/(r (1 + k)), and one that spins by g s/(k r²), k = 2/5.
#include <cmath>

#include "core/engine/engine_failure.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_impulse_turning_friction)

namespace {

constexpr double kG = 9.81, kBallRadius = 0.1, kRound = 0.4;  // m/s², m, 1
// s, a sub-step of a ball of 10 cm: as long as it takes until contacts carry the first load.
constexpr double kFirst = 1.0 / 480;

Scene ball_on_floor(const ContactLaw& law) {
  return on_floor({solid("ball", Sphere{kBallRadius}, {0, 0, kBallRadius}, 2)}, law);
}

Scene rolling_ball(double heading, double speed, double rolling_friction) {
  Scene scene = ball_on_floor({.friction = 0.5, .rolling_friction = rolling_friction});
  const Vec3 way(std::cos(heading), std::sin(heading), 0);
  scene.bodies[0].velocity = speed * way;
  scene.bodies[0].angular_velocity = speed / kBallRadius * Vec3::UnitZ().cross(way);
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_ball_rolls_to_rest_in_any_direction) {
  const double speed = 0.5, length = 0.002, brake = kG * length / (kBallRadius * (1 + kRound)), stop = speed / brake;
  for (const double heading : {0.0, 0.4, 0.785, 2.5}) {
    for (const double dt : {1.0 / 30, 1.0 / 240}) {
      ContactRun run(rolling_ball(heading, speed, length), "impulse");
      const int half = static_cast<int>(std::lround(0.5 * stop / dt));
      run.run(dt, half);
      BOOST_TEST_CONTEXT("heading " << heading << " dt " << dt) {
        // The first sub-steps settle friction: a sub-step of at most 1/480 s at the brake's acceleration.
        BOOST_TEST(std::abs(run.state().velocity(0).norm() - (speed - brake * half * dt)) < brake * kFirst);
        run.run(dt, 2 * half);
        const Vec3 end = run.state().position(0);
        BOOST_TEST(std::abs(end.head<2>().norm() - speed * stop / 2) < 1e-3 * speed * stop);
        BOOST_TEST(std::abs(std::remainder(std::atan2(end.y(), end.x()) - heading, 2 * std::numbers::pi)) < 1e-6);
        BOOST_TEST(run.state().velocity(0).norm() < 1e-12);
        BOOST_TEST(run.state().angular_velocity(0).norm() < 1e-11);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_ball_spins_to_rest) {
  const double spin = 5, length = 0.002, brake = kG * length / (kRound * kBallRadius * kBallRadius),
               stop = spin / brake;
  for (const double dt : {1.0 / 30, 1.0 / 240}) {
    Scene scene = ball_on_floor({.friction = 0.5, .torsional_friction = length});
    scene.bodies[0].angular_velocity = {0, 0, spin};
    ContactRun run(scene, "impulse");
    const int half = static_cast<int>(std::lround(0.5 * stop / dt));
    run.run(dt, half);
    BOOST_TEST(std::abs(run.state().angular_velocity(0).z() - (spin - brake * half * dt)) < brake * kFirst);
    run.run(dt, 2 * half);
    BOOST_TEST(run.state().angular_velocity(0).norm() < 1e-12);
    BOOST_TEST(run.state().position(0).head<2>().norm() < 1e-12);
  }
}

// The couple holds while tan(slope) < d/r, and the ball rolls with g (sin - d/r cos)/(1 + k) above.
BOOST_AUTO_TEST_CASE(a_ball_holds_on_a_slope_below_the_threshold_and_rolls_above) {
  for (const double share : {0.9, 1.5}) {
    const double length = 0.01, slope = std::atan(share * length / kBallRadius);
    Scene scene = ball_on_floor({.friction = 0.5, .rolling_friction = length});
    scene.gravity = kG * Vec3(std::sin(slope), 0, -std::cos(slope));
    ContactRun run(scene, "impulse");
    run.run(1.0 / 240, 480);
    const double rolls = kG * (std::sin(slope) - length / kBallRadius * std::cos(slope)) / (1 + kRound);
    if (share < 1) {
      BOOST_TEST(run.state().velocity(0).norm() < 1e-9);
      BOOST_TEST(run.state().position(0).head<2>().norm() < 2 * kG * std::sin(slope) * kFirst * kFirst);
    } else {
      BOOST_TEST(std::abs(run.state().velocity(0).x() - 2 * rolls) < kG * std::sin(slope) * kFirst);
    }
  }
}

// What the ball loses the box gains, for the floor below has no friction. The box tilts by some 1e-5 rad on its soft
// corners, and the square of that is lost from its moment about the vertical.
BOOST_AUTO_TEST_CASE(couples_act_on_both_bodies) {
  Scene scene = on_floor({solid("ball", Sphere{kBallRadius}, {0, 0, 0.2 + kBallRadius}, 2),
                          solid("box", Box{{0.4, 0.4, 0.2}}, {0, 0, 0.1}, 5)},
                         {0, 0});
  scene.contact_pairs = {{0, 1, {.friction = 0.5, .torsional_friction = 0.002}}};
  scene.bodies[0].angular_velocity = {0, 0, 20};
  const double ball = scene.bodies[0].inertia(2, 2), box = scene.bodies[1].inertia(2, 2), before = 20 * ball;
  ContactRun run(scene, "impulse");
  run.run(1.0 / 240, 240);
  const double after = ball * run.state().angular_velocity(0).z() + box * run.state().angular_velocity(1).z();
  BOOST_TEST(run.state().angular_velocity(1).z() > 0.01);
  BOOST_TEST(std::abs(after - before) < 1e-9 * before);
}

BOOST_AUTO_TEST_CASE(restitution_beside_it_is_refused) {
  Scene scene = rolling_ball(0, 1, 0.002);
  scene.bodies.push_back(solid("other", Sphere{kBallRadius}, {3, 0, kBallRadius}));
  scene.contact_pairs = {{0, 2, {.restitution = 0.5}}};
  BOOST_CHECK_THROW(ContactRun(scene, "impulse"), EngineFailure);
  scene.contact_pairs.clear();
  BOOST_CHECK_NO_THROW(ContactRun(scene, "impulse"));
}

BOOST_AUTO_TEST_SUITE_END()
