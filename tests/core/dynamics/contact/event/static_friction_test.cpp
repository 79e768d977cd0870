// Contact by events where points that do not slide have more friction than those that do, against Coulomb's law.
#include <cmath>

#include "tests/core/dynamics/contact/contact_runs.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_static_friction)

namespace {

constexpr double kG = 9.81, kMass = 10, kSliding = 0.4, kSticking = 0.5;  // m/s², kg, 1, 1
constexpr ContactLaw kLaw = {.friction = kSliding, .static_friction = kSticking};

Body brick(const std::string& name = "brick", const Vec3& position = {0, 0, 0.1}) {
  return solid(name, Box{{0.4, 0.4, 0.2}}, position, kMass);
}

TimedForce pull(const Vec3& force, double from = 0, double until = std::numeric_limits<double>::infinity()) {
  TimedForce pull;
  pull.body = 0, pull.force = force, pull.from = from, pull.until = until;
  return pull;
}

Scene pulled(double force, double heading = 0) {
  Scene scene = on_floor({brick()}, kLaw);
  scene.forces = {pull(force * Vec3(std::cos(heading), std::sin(heading), 0))};
  return scene;
}

// On a slope that rises along x, with a speed up it.
Scene thrown_up(double slope, double speed, const ContactLaw& law) {
  Scene scene = on_floor({brick()}, law, kG * Vec3(-std::sin(slope), 0, -std::cos(slope)));
  scene.bodies[0].velocity = {speed, 0, 0};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(less_than_static_friction_moves_nothing) {
  for (const double heading : {0.0, 0.6, 2.0}) {
    ContactRun run(pulled(0.999 * kSticking * kMass * kG, heading), "event");
    run.run(0.01, 100);
    BOOST_TEST(run.state().velocity(0).norm() < 1e-12);
    BOOST_TEST(run.state().position(0).head<2>().norm() < 1e-12);
  }
}

// Both integrators are exact for a constant acceleration.
BOOST_AUTO_TEST_CASE(more_than_static_friction_leaves_the_friction_of_sliding) {
  const double force = 1.001 * kSticking * kMass * kG, acceleration = force / kMass - kSliding * kG;
  for (const char* integrator : {"velocity-verlet", "rk4"}) {
    for (const double heading : {0.0, 0.6, 2.0}) {
      for (const double dt : {1.0 / 30, 1.0 / 1000}) {
        ContactRun run(pulled(force, heading), "event", integrator);
        const int steps = static_cast<int>(std::lround(1 / dt));
        run.run(dt, steps);
        const Vec3 end = run.state().position(0);
        BOOST_TEST(std::abs(end.head<2>().norm() - acceleration / 2) < 1e-9, integrator << " " << heading << " " << dt);
        BOOST_TEST(std::abs(end.y() * std::cos(heading) - end.x() * std::sin(heading)) < 1e-9);
        BOOST_TEST(run.solver_warning() == "");
      }
    }
  }
}

// The slope's tangent lies between the two coefficients: what comes to rest there stays. With one coefficient it slides
// back with g (sin - mu cos).
BOOST_AUTO_TEST_CASE(a_brick_thrown_up_a_slope_stops_and_stays) {
  const double slope = std::atan(0.45), speed = 2, brake = kG * (std::sin(slope) + kSliding * std::cos(slope)),
               stops = speed / brake, height = speed * stops / 2, dt = 0.01;
  const int steps = 100;
  ContactRun sticks(thrown_up(slope, speed, kLaw), "event"),
      slides(thrown_up(slope, speed, {.friction = kSliding}), "event");
  sticks.run(dt, steps), slides.run(dt, steps);
  BOOST_TEST(std::abs(sticks.state().position(0).x() - height) < 1e-9);
  BOOST_TEST(sticks.state().velocity(0).norm() < 1e-12);
  const double rest = steps * dt - stops, back = kG * (std::sin(slope) - kSliding * std::cos(slope)) * rest * rest / 2;
  BOOST_TEST(std::abs(slides.state().position(0).x() - (height - back)) < 1e-9);
}

BOOST_AUTO_TEST_CASE(a_pull_that_grows_breaks_the_brick_away_at_the_larger_limit) {
  Scene scene = on_floor({brick()}, kLaw);
  const double limit = kSticking * kMass * kG;
  // In steps of a twentieth of the limit, 0.1 s each: the first above it begins at 2 s.
  for (int k = 0; k < 30; ++k) scene.forces.push_back(pull({(k + 0.5) / 20 * limit, 0, 0}, 0.1 * k, 0.1 * (k + 1)));
  ContactRun run(scene, "event");
  run.run(0.03, 66);
  const double before = run.state().position(0).x();
  BOOST_TEST(std::abs(before) < 1e-12);
  run.run(0.03, 34);
  double speed = 0, place = 0;
  for (int k = 20; k < 30; ++k) {
    const double acceleration = (k + 0.5) / 20 * limit / kMass - kSliding * kG;
    place += speed * 0.1 + acceleration * 0.005, speed += 0.1 * acceleration;
  }
  BOOST_TEST(std::abs(run.state().velocity(0).x() - speed) < 1e-9);
  BOOST_TEST(std::abs(run.state().position(0).x() - place) < 1e-9);
}

// A brick on a board that is pulled away under it, over a smooth floor. The board gains more than static friction can
// give the brick, so both accelerate by the friction of sliding.
BOOST_AUTO_TEST_CASE(a_board_is_pulled_away_under_a_brick) {
  const double board_mass = 5;
  Body board = solid("board", Box{{2, 2, 0.1}}, {0, 0, 0.05}, board_mass);
  Scene scene = on_floor({board, brick("brick", {0, 0, 0.2})}, {});
  scene.contact_pairs = {{0, 1, kLaw}};
  const double limit = kSticking * kG * (kMass + board_mass);
  for (const double share : {0.99, 1.01}) {
    scene.forces = {pull({share * limit, 0, 0})};
    ContactRun run(scene, "event");
    run.run(0.01, 50);
    const double together = share * limit / (kMass + board_mass), t = 0.5;
    const double of_brick = share < 1 ? together : kSliding * kG,
                 of_board = share < 1 ? together : (share * limit - kMass * kSliding * kG) / board_mass;
    BOOST_TEST(std::abs(run.state().position(0).x() - of_board * t * t / 2) < 1e-9, share);
    BOOST_TEST(std::abs(run.state().position(1).x() - of_brick * t * t / 2) < 1e-9, share);
  }
}

// Two bricks that a rod holds apart. The pulled one would slip alone, but the rod shares the pull. Where both together
// do not hold it, both slip.
BOOST_AUTO_TEST_CASE(a_point_that_slips_may_make_another_slip) {
  constexpr double kOther = 0.1, kOtherSticking = 0.11;
  const double weight = kMass * kG;
  for (const double share : {0.99, 1.01}) {
    const double force = share * (kSticking + kOtherSticking) * weight;
    Scene scene = on_floor({brick(), brick("second", {1, 0, 0.1})}, kLaw);
    scene.contact_pairs = {{1, 2, {.friction = kOther, .static_friction = kOtherSticking}}};
    scene.joints = {{.a = 0, .b = 1, .type = DistanceJoint{Vec3::Zero(), Vec3::Zero()}}};
    scene.forces = {pull({-force, 0, 0})};
    const BodyTable end = state_after(scene, "velocity-verlet", 0.01, 0.5);
    const double acceleration = share < 1 ? 0 : (force - (kSliding + kOther) * weight) / (2 * kMass);
    BOOST_TEST(std::abs(end.columns().position(0).x() + acceleration * 0.125) < 1e-9, share);
  }
}

BOOST_AUTO_TEST_SUITE_END()
