// Crowded events: the cost of a run is bounded, and the inelastic steps that follow still satisfy the laws. Also tests
// sliding along a curved path, for which the direction of friction is evaluated at each stage.
#include <boost/test/data/test_case.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/contact/contact_runs.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_crowded_events)

namespace {

constexpr double kStep = 1.0 / 30;  // s

Scene dominoes(int count) {
  std::vector<Body> row;
  for (int i = 0; i < count; ++i) row.push_back(solid("domino", Box{{0.2, 0.5, 1}}, {0.6 * i, 0, 0.5}));
  row[0].angular_velocity = {0, 1.2, 0}, row[0].velocity = {0.6, 0, 0.12};
  return on_floor(row, {0, 0.5});
}

// A step adds no more than what it lifts bodies by to part them, h²g of each one's weight at most. Returns how far the
// lowest body's centre came down.
void fall(const Scene& scene, ContactRun& run, double t) {
  double least = energy(scene, run.state()), weight = 0;
  for (const Body& body : scene.bodies) weight += body.fixed ? 0 : body.mass * 9.81;
  while (run.time() < t) {
    run.step(kStep);
    const double now = energy(scene, run.state());
    if (!(now <= least + weight * 9.81 * kStep * kStep / 16))
      BOOST_TEST(now <= least, "at " << run.time() << " s by " << now - least << " J");
    least = std::min(least, now);
  }
  BOOST_TEST(run.solver_warning() == "");
}

Body any_body(std::mt19937& random, int i) {
  const auto between = [&](double low, double high) { return low + (high - low) * random() / 4294967296.0; };
  const Vec3 position(1.2 * (i % 3), 1.2 * (i / 3 % 2), 0.6 + 1.1 * (i / 6));
  const Shape shapes[] = {Box{{between(0.1, 0.6), between(0.1, 0.6), between(0.1, 0.6)}}, Sphere{between(0.1, 0.3)},
                          Capsule{between(0.06, 0.2), between(0.1, 0.6)}};
  Body body = solid("any", shapes[random() % 3], position);
  body.orientation = rotation_by({between(-2, 2), between(-2, 2), between(-2, 2)});
  body.velocity = {between(-3, 3), between(-3, 3), between(-3, 3)};
  body.angular_velocity = {between(-5, 5), between(-5, 5), between(-5, 5)};
  return body;
}

}  // namespace

BOOST_DATA_TEST_CASE(a_row_of_dominoes_falls_and_comes_to_lie, boost::unit_test::data::make({3, 10}), count) {
  const Scene scene = dominoes(count);
  ContactRun run(scene, "event");
  fall(scene, run, 5);
  for (int i = 0; i < count; ++i) {
    BOOST_TEST(angle_between(run.state().orientation(i), Quat::Identity()) > 1);
    // g h, of a step of 1/120 s, is what such a step may leave of a speed.
    BOOST_TEST(run.state().velocity(i).norm() < 9.81 / 120);
  }
}

// Painlevé's paradox needs mu x h > I/m + x²: of a cube, which turns to x = h/2 at worst, mu > 4/3.
BOOST_AUTO_TEST_CASE(a_cube_thrown_along_a_floor_meets_no_paradox) {
  for (const double friction : {0.5, 1.0, kInfiniteFriction}) {
    for (const double side : {0.2, 1.0}) {
      for (const double restitution : {0.0, 0.5}) {
        BOOST_TEST_CONTEXT("friction " << friction << ", side " << side << ", restitution " << restitution) {
          Body cube = solid("cube", Box{{side, side, side}}, {0, 0, 0.5 * side});
          cube.velocity = {5, 0, 0};
          const Scene scene = on_floor({cube}, {restitution, friction});
          ContactRun run(scene, "event");
          fall(scene, run, 3);
        }
      }
    }
  }
}

BOOST_DATA_TEST_CASE(ten_bodies_that_are_thrown_together_cost_no_more_than_was_saved,
                     boost::unit_test::data::make({1, 2, 3, 4, 5, 6}), seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::vector<Body> bodies;
  for (int i = 0; i < 4 + seed; ++i) bodies.push_back(any_body(random, i));
  const Scene scene = on_floor(bodies, {0.1 * seed, 0.15 * seed});
  ContactRun run(scene, "event");
  fall(scene, run, 3);
  for (std::size_t i = 0; i < bodies.size(); ++i) BOOST_TEST(run.state().position(i).z() > 0);
}

BOOST_AUTO_TEST_CASE(a_log_that_slides_and_spins_is_followed_whatever_the_step) {
  Body log = solid("log", Capsule{0.1, 0.6}, {0, 0, 0.1});
  log.orientation = rotation_by({0, 0.5 * std::numbers::pi, 0});
  log.velocity = {1, 2, 0}, log.angular_velocity = {0, 0, 4};
  const Scene scene = on_floor({log}, {0, 0.3});
  const auto after = [&](const char* integrator, int steps) {
    ContactRun run(scene, "event", integrator);
    run.run(0.2 / steps, steps);
    return run.state().body(0);
  };
  const BodyState exact = after("dormand-prince", 12);
  // It does turn: each end slides another way.
  BOOST_TEST(std::abs(exact.velocity.x() / exact.velocity.y() - 0.5) > 1e-3);
  // In steps that are long beside the time in which friction turns a slip, an adaptive method takes over.
  for (const char* integrator : {"rk4", "rkmk4"}) {
    for (const int steps : {3, 6, 12})
      BOOST_TEST((after(integrator, steps).position - exact.position).norm() < 1e-11, integrator << ", " << steps);
  }
}

BOOST_AUTO_TEST_CASE(a_run_says_from_when_on_its_events_were_crowded) {
  ContactRun calm(on_floor({solid("ball", Sphere{0.1}, {0, 0, 1})}, {0.5, 0.5}), "event");
  calm.run(kStep, 60);
  BOOST_TEST(!calm.reduced_order());
  ContactRun row(dominoes(10), "event");
  row.run(kStep, 30);
  BOOST_TEST(!row.reduced_order());  // one after another they fall event by event
  row.run(kStep, 90);
  BOOST_REQUIRE(row.reduced_order());
  BOOST_TEST(row.reduced_order()->from > 30 * kStep);
  BOOST_TEST(row.reduced_order()->from < 120 * kStep);
  const ReducedOrder at_first = *row.reduced_order();
  row.run(kStep, 30);
  BOOST_TEST(row.reduced_order()->from == at_first.from);
  BOOST_TEST(row.reduced_order()->how != at_first.how);  // it counts on
}

// Explicit Euler makes the spring's energy grow without bounds. Each short step was a part of what was left of a step,
// so that their number did.
BOOST_AUTO_TEST_CASE(a_run_that_blows_up_takes_a_bounded_number_of_short_steps) {
  constexpr int kSteps = 480, kMost = 2000;  // measured 786 a step; 1/64 of the longest, 0.2 ms, allows 1200
  ContactRun run(suite_scene("contact/sprung-ball-in-step"), "event", "explicit-euler");
  run.run(1.0 / 240, kSteps);
  BOOST_REQUIRE(run.reduced_order());
  const std::string how = run.reduced_order()->how, by = "in part by ";
  BOOST_REQUIRE(how.starts_with(by));
  BOOST_TEST(std::stol(how.substr(by.size())) <= kMost * kSteps, how);
}

BOOST_AUTO_TEST_SUITE_END()
