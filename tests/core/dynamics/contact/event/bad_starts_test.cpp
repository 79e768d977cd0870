// Tests `event` with bodies that overlap at the start, and with bodies that rest while others move.
#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_bad_starts)

namespace {

constexpr double kStep = 1.0 / 30;  // s
constexpr double kTouching = 1e-9;  // m

double least_distance(BodyColumns state, int count) {
  double least = 1e9;
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < i; ++k) least = std::min(least, (state.position(i) - state.position(k)).norm());
  }
  return least;
}

}  // namespace

BOOST_AUTO_TEST_CASE(spheres_in_one_place_part_to_all_sides_without_speed) {
  for (const int count : {2, 30, 90}) {  // 90 have 4005 overlaps, more than are parted together
    std::vector<Body> bodies;
    for (int i = 0; i < count; ++i) bodies.push_back(solid("s" + std::to_string(i), Sphere{0.1}, {0, 0, 5}));
    ContactRun run(on_floor(bodies, {0, 0.5}, Vec3::Zero()), "event");
    run.step(kStep);
    BOOST_TEST_CONTEXT(count << " spheres") {
      BOOST_TEST(run.solver_warning() == "");
      BOOST_TEST(least_distance(run.state(), count) > 0.2 - 0.01);  // a tenth of the radius is called a jam
      Vec3 low = run.state().position(0), high = low;
      for (int i = 0; i < count; ++i) {
        BOOST_TEST(run.state().velocity(i).norm() == 0);
        low = low.cwiseMin(run.state().position(i)), high = high.cwiseMax(run.state().position(i));
      }
      if (count > 2) BOOST_TEST((high - low).minCoeff() > 0.2);
    }
  }
}

// More than forces at each stage can be found for: it took minutes for a second. They come apart within the first step
// and fall, none through the floor or so deep into another that the run would name the two; it says by what steps.
BOOST_AUTO_TEST_CASE(five_hundred_spheres_in_one_place_above_a_floor_part_and_fall) {
  constexpr int kCount = 500, kSteps = 15;
  for (const double height : {1.5, 0.0}) {
    std::vector<Body> bodies;
    for (int i = 0; i < kCount; ++i) bodies.push_back(solid("s" + std::to_string(i), Sphere{0.1}, {0, 0, height}));
    const Scene scene = on_floor(bodies, {0, 0.5});
    ContactRun run(scene, "event");
    run.step(kStep);
    BOOST_TEST_CONTEXT("from " << height << " m") {
      BOOST_REQUIRE(run.reduced_order());
      BOOST_TEST(run.reduced_order()->from == 0);
      BOOST_TEST(run.reduced_order()->how.find("more than 128 bodies touch each other") != std::string::npos);
      BOOST_TEST(least_distance(run.state(), kCount) > 0.2 - 0.01);  // as above
      const double after_parting = energy(scene, run.state());
      run.run(kStep, kSteps);
      BOOST_TEST(run.solver_warning() == "");
      BOOST_TEST(energy(scene, run.state()) < after_parting);
      for (int i = 0; i < kCount; ++i) BOOST_TEST(run.state().position(i).z() > 0);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_body_without_room_is_named) {
  Scene scene = on_floor({solid("ball", Sphere{0.1}, {0, 0, 0.5})}, {0, 0.5});
  for (const double side : {1.0, -1.0}) {
    scene.bodies.push_back(floor_at(Vec3(side, 0, 0), -0.05));
    scene.bodies.back().name = side > 0 ? "left" : "right";
  }
  ContactRun run(scene, "event");
  run.run(kStep, 3);
  BOOST_TEST(run.solver_warning().find("ball and ") == 0, run.solver_warning());
  BOOST_TEST(run.solver_warning().find("no way was found to part all bodies") != std::string::npos);
}

// A resting body is set aside, and must be there again when it is struck.
BOOST_AUTO_TEST_CASE(what_rests_stays_to_the_last_bit_until_it_is_struck) {
  Body ball = solid("ball", Sphere{0.1}, {-1, 0, 0.1});
  ball.velocity = {1, 0, 0}, ball.angular_velocity = {0, 10, 0};
  ContactRun run(on_floor({solid("box", Box{{0.4, 0.4, 0.4}}, {0, 0, 0.2}), ball}, {0, 0.3}), "event", "rk4");
  run.run(kStep, 20);  // the ball comes 0.667 m far, and touches at 0.7
  BOOST_TEST(run.state().position(0) == Vec3(0, 0, 0.2));
  BOOST_TEST((run.state().position(1) - Vec3(-1 + 20 * kStep, 0, 0.1)).norm() < kTouching);
  run.run(kStep, 10);
  BOOST_TEST(run.state().position(0).x() > 1e-3);
  BOOST_TEST(run.state().position(1).x() + 0.1 <= run.state().position(0).x() - 0.2 + kTouching);
  BOOST_TEST(run.solver_warning() == "");
}

BOOST_AUTO_TEST_SUITE_END()
