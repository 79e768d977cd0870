// Impacts of contact by impulses: at their own instants, several at once by the law that the run names, and never with
// a gain of energy.
#include "core/dynamics/contact/impulse/rebounds/rebounds.h"

#include <cmath>
#include <numbers>

#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_impulse_rebounds_rebounds)

namespace {

const char* const kIntegrators[] = {"semi-implicit-euler", "velocity-verlet", "rk4"};

Scene elastic(std::vector<Body> bodies, double friction = 0) {
  Scene scene;
  scene.contact_default = {1, friction};
  scene.bodies = std::move(bodies);
  return scene;
}

Body ball(const std::string& name, const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  Body body = solid(name, Sphere{0.5}, position);
  body.velocity = velocity;
  return body;
}

// Balls that touch, `count` of them, and one that comes from each side.
Scene row_hit_from_both_sides(int count) {
  std::vector<Body> balls = {ball("left", {-2, 0, 0}, {1, 0, 0})};
  for (int i = 0; i < count; ++i) balls.push_back(ball("ball " + std::to_string(i), {1.0 * i, 0, 0}));
  balls.push_back(ball("right", {count + 1.0, 0, 0}, {-1, 0, 0}));
  return elastic(balls);
}

double farthest_apart(BodyColumns a, BodyColumns b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a.position(i) - b.position(i)).norm());
  return most;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_row_of_balls_hit_from_both_sides_passes_the_blows_through) {
  for (const int count : {3, 5}) {
    const Scene scene = row_hit_from_both_sides(count);
    ContactRun event(scene, "event");
    event.run(1.0 / 30, 90);
    for (const char* integrator : kIntegrators) {
      ContactRun run(scene, "impulse", integrator);
      run.run(1.0 / 30, 90);
      // Balls that touch are at rest again, and those at the ends fly back as they came.
      BOOST_TEST(std::abs(rigor::energy(scene, run.state()) - 1) < 1e-12, integrator);
      BOOST_TEST(farthest_apart(run.state(), event.state()) < 1e-9, integrator);
      BOOST_TEST((run.state().velocity(0) - Vec3(-1, 0, 0)).norm() < 1e-12, integrator);
    }
  }
}

// One ball against a row of three at rest: the last one flies on alone, or by Moreau's law the two neighbours share.
BOOST_AUTO_TEST_CASE(several_impacts_at_once_go_by_the_law_that_is_named) {
  const Scene scene =
      elastic({ball("cue", {-2, 0, 0}, {1, 0, 0}), ball("a", {0, 0, 0}), ball("b", {1, 0, 0}), ball("c", {2, 0, 0})});
  for (const char* integrator : kIntegrators) {
    ContactRun sequential(scene, "impulse", integrator),
        named(scene, "impulse", integrator, {{"impacts", "sequential"}}),
        together(scene, "impulse", integrator, {{"impacts", "simultaneous"}});
    for (ContactRun* run : {&sequential, &named, &together}) run->run(1.0 / 30, 60);
    BOOST_TEST((sequential.state().velocity(3) - Vec3(1, 0, 0)).norm() < 1e-12, integrator);
    BOOST_TEST(sequential.state().velocity(0).norm() < 1e-12, integrator);
    BOOST_TEST(farthest_apart(sequential.state(), named.state()) == 0, integrator);
    // u' = -u at the blow, 0 where nothing approaches: the three fly on as one, at 2 m / (m + 3 m) of the speed.
    BOOST_TEST((together.state().velocity(0) - Vec3(-0.5, 0, 0)).norm() < 1e-11, integrator);
    for (const std::size_t i : {1, 2, 3})
      BOOST_TEST((together.state().velocity(i) - Vec3(0.5, 0, 0)).norm() < 1e-11, integrator << " " << i);
  }
}

BOOST_AUTO_TEST_CASE(a_bounce_is_met_within_its_sub_step) {
  // Velocity Verlet flies a parabola as it is: what is left are roundings of a dozen bounces.
  const double g = 9.81, height = 1, e = 1, fall = std::sqrt(2 * height / g), speed = g * fall;
  ContactRun run(on_floor({solid("ball", Sphere{0.1}, {0, 0, height + 0.1})}, {e, 0}), "impulse");
  for (int n = 0; n < 300; ++n) {
    run.step(1.0 / 30);
    const double since = std::fmod(run.time() + fall, 2 * fall), z = speed * since - 0.5 * g * since * since;
    BOOST_TEST_REQUIRE(std::abs(run.state().position(0).z() - 0.1 - z) < 1e-10, run.time());
  }
}

BOOST_AUTO_TEST_CASE(an_uneven_box_in_a_closed_room_gains_no_energy) {
  for (const double friction : {0.0, 1.0}) {
    for (const char* integrator : kIntegrators) {
      // Explicit parts of these schemes change the energy of a tumbling flight. Each impact is compared with the energy
      // one step before, without that change.
      Scene scene = elastic({solid("box", Box{{0.6, 1, 0.3}}, {0.1, 0.2, 0.3})}, friction);
      scene.bodies[0].velocity = {2, 1.3, -0.7}, scene.bodies[0].angular_velocity = {3, -2, 1};
      for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) scene.bodies.push_back(floor_at(sign * Vec3::Unit(axis), -1.2));
      }
      ContactRun run(scene, "impulse", integrator, {{"substeps", "5"}});
      double last = rigor::energy(scene, run.state()), gained = 0;
      for (int n = 0; n < 1000; ++n) {
        run.step(1.0 / 100);
        const double now = rigor::energy(scene, run.state());
        gained = std::max(gained, now - last), last = now;
      }
      // A free turn by w h in a sub-step of 1/500 s errs by (w h)² of the energy at first order.
      const double turn = 10.0 / 500, of_flight = std::string(integrator) == "semi-implicit-euler" ? turn * turn : 1e-7;
      BOOST_TEST(gained < of_flight * 4, integrator << ", friction " << friction << ": " << gained);
    }
  }
}

// A rod that makes half a turn in a step meets the ball at any place of a sub-step or of an interval between contact
// updates. At eighths of a turn it missed the ball, or threw it aside along a normal that rounding chose.
BOOST_AUTO_TEST_CASE(a_fast_rod_meets_a_ball_wherever_it_lies) {
  const double dt = 1.0 / 30, w = std::numbers::pi / dt, r = 0.05, away = 0.9, s = std::sqrt(away * away - 4 * r * r);
  for (int k = 12; k <= 168; k += 3) {
    const double angle = k * std::numbers::pi / 180;
    Scene scene = elastic({solid("rod", Capsule{r, 2}, Vec3::Zero(), 3),
                           solid("ball", Sphere{r}, away * Vec3(std::cos(angle), std::sin(angle), 0), 0.5)});
    scene.bodies[0].orientation = Quat(std::sqrt(0.5), 0, std::sqrt(0.5), 0);  // its axis, z in B, along x
    scene.bodies[0].angular_velocity = {0, 0, w};
    const double expected = 2 * w * s / (1 / 0.5 + 1 / 3.0 + s * s / scene.bodies[0].inertia(0, 0)) / 0.5;
    ContactRun run(scene, "impulse");
    run.step(dt);
    // Steps that no point can outrun locate the impact, to 2 % of the inradius.
    BOOST_TEST(std::abs(run.state().velocity(1).norm() / expected - 1) < 0.02, k << " degrees");
    BOOST_TEST(std::abs(run.state().velocity(1).z()) < 1e-9, k << " degrees");
  }
}

BOOST_AUTO_TEST_CASE(bodies_in_one_place_part_and_stand_still) {
  for (const char* integrator : kIntegrators) {
    Scene balls = elastic({ball("a", Vec3::Zero()), ball("b", Vec3::Zero()), ball("c", Vec3::Zero())});
    ContactRun run(balls, "impulse", integrator);
    run.run(1.0 / 30, 60);
    for (const auto& [a, b] : {std::pair(0, 1), {0, 2}, {1, 2}})
      BOOST_TEST((run.state().position(a) - run.state().position(b)).norm() > 1 - 1e-3, integrator);
    BOOST_TEST(rigor::energy(balls, run.state()) < 1e-6, integrator);
    BOOST_TEST(run.solver_warning() == "");
    const Scene boxes = elastic({solid("a", Box{{1, 1, 1}}, Vec3::Zero()), solid("b", Box{{1, 1, 1}}, Vec3::Zero())});
    ContactRun two(boxes, "impulse", integrator);
    two.run(1.0 / 30, 60);
    // Below a fiftieth of the inradius, 1 cm, one pass relaxes what pushes at 70/s of it: a tenth is left, 7 cm/s.
    BOOST_TEST(rigor::energy(boxes, two.state()) < 0.07 * 0.07,
               integrator << ": " << rigor::energy(boxes, two.state()));
    BOOST_TEST((two.state().position(0) - two.state().position(1)).norm() > 1 - 1e-3, integrator);
  }
}

BOOST_AUTO_TEST_CASE(what_impulses_do_not_hold_is_named) {
  const Scene scene = on_floor(
      {solid("light", Box{{1, 1, 1}}, {0, 0, 0.5}), solid("heavy", Box{{1, 1, 1}}, {0, 0, 1.5}, 1e24)}, {0, 0.5});
  ContactRun run(scene, "impulse");
  run.run(1.0 / 30, 60);
  BOOST_TEST(run.solver_warning().find("overlap by") != std::string::npos, run.solver_warning());
  // Initial overlap is removed as far as there is room: a box between two planes stays between them.
  Scene narrow = on_floor({solid("box", Box{{1, 1, 1}}, {0, 0, 0.5})}, {0, 0.5});
  narrow.bodies.push_back(floor_at(-Vec3::UnitZ(), -0.8));
  ContactRun squeezed(narrow, "impulse");
  squeezed.run(1.0 / 30, 90);
  BOOST_TEST(squeezed.state().position(0).z() > 0.3);
  BOOST_TEST(squeezed.state().position(0).z() < 0.5);
  BOOST_TEST(squeezed.state().velocity(0).norm() < 1e-3);
}

BOOST_AUTO_TEST_SUITE_END()
