// Scenes that rest under steady loads, until something changes.
#include <cmath>

#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_rest)

namespace {

constexpr double kG = 9.81, kDt = 0.01;  // m/s², s

// A box of 1 kg that a force presses against the wall x = 0 until the given time. Friction of 0.5 holds it.
Scene at_wall(double until) {
  Scene scene;
  scene.gravity = {0, 0, -kG};
  scene.bodies = {solid("box", Box{{0.2, 0.2, 0.2}}, {0.1, 0, 0}), floor_at(Vec3::UnitX())};
  scene.contact_default = {0, 0.5};
  scene.forces.push_back({.body = 0, .force = {-4 * kG, 0, 0}, .until = until});
  return scene;
}

double fall(double t) { return -0.5 * kG * t * t; }

}  // namespace

BOOST_AUTO_TEST_CASE(a_pressed_box_rests_until_its_force_ends) {
  // At a step's end, and within a step.
  for (const double until : {30 * kDt, 30.5 * kDt}) {
    ContactRun run(at_wall(until), "event");
    run.run(kDt, 30);
    BOOST_TEST(run.state().position(0) == Vec3(0.1, 0, 0));
    run.run(kDt, 20);
    BOOST_TEST(std::abs(run.state().position(0).z() - fall(50 * kDt - until)) < 1e-12, "until " << until);
  }
}

BOOST_AUTO_TEST_CASE(a_box_that_rests_begins_to_slide_when_a_force_begins) {
  for (const double from : {30 * kDt, 30.5 * kDt}) {
    Scene scene = at_wall(1e9);
    // Beyond the 2 g that friction bears: it slides up the wall, and friction adds to its weight.
    scene.forces.push_back({.body = 0, .force = {0, 0, 5 * kG}, .from = from});
    ContactRun run(scene, "event");
    run.run(kDt, 50);
    const double t = 50 * kDt - from;
    BOOST_TEST(std::abs(run.state().position(0).z() - 0.5 * (5 - 1 - 2) * kG * t * t) < 1e-10, "from " << from);
  }
}

BOOST_AUTO_TEST_CASE(a_box_that_rests_reports_the_same_forces_at_each_step) {
  ContactRun run(at_wall(30.5 * kDt), "event");
  run.contact_reports().ask_for_contacts();
  const auto sum = [&] {
    Vec3 force = Vec3::Zero();
    for (const ReportedContact& contact : run.contact_reports().contacts())
      force += contact.b == 0 ? contact.force : Vec3(-contact.force);
    return force;
  };
  for (int n = 1; n <= 30; ++n) {
    run.step(kDt);
    BOOST_TEST((sum() - Vec3(4 * kG, 0, kG)).norm() < 1e-12 * kG, "step " << n);
  }
  run.step(kDt);  // the force ends in its middle
  BOOST_TEST((sum() - 0.5 * Vec3(4 * kG, 0, kG)).norm() < 1e-10 * kG);
  run.step(kDt);
  BOOST_TEST(sum().norm() < 1e-12 * kG);
}

BOOST_AUTO_TEST_CASE(a_step_without_length_does_not_take_the_forces_away) {
  ContactRun run(at_wall(1e9), "event");
  run.contact_reports().ask_for_contacts();
  for (const double dt : {kDt, kDt, 0.0, kDt}) run.step(dt);
  BOOST_TEST(!run.contact_reports().contacts().empty());
}

BOOST_AUTO_TEST_CASE(a_box_that_rests_is_moved_by_one_that_strikes_it) {
  Scene scene = at_wall(1e9);
  scene.bodies.push_back(solid("ball", Sphere{0.1}, {0.1, 0, -1}));
  scene.bodies.back().velocity = {0, 0, 10};
  ContactRun run(scene, "event");
  run.run(kDt, 5);
  BOOST_TEST(run.state().position(0) == Vec3(0.1, 0, 0));
  run.run(kDt, 10);
  BOOST_TEST(run.state().velocity(0).z() > 1);
}

// The spring's other end swings: it lifts the box when it pulls by more than the weight.
BOOST_AUTO_TEST_CASE(a_box_on_a_spring_whose_other_end_moves_does_not_go_on_resting) {
  Scene scene = on_floor({solid("box", Box{{0.2, 0.2, 0.2}}, {0, 0, 0.1})}, {0, 0.5});
  scene.bodies.push_back(solid("weight", Sphere{0.1}, {0, 0, 2}));
  scene.bodies.back().velocity = {0, 0, 5};
  scene.springs.push_back({.a = 0, .b = 2, .stiffness = 100, .rest_length = 1.9});
  ContactRun run(scene, "event");
  run.run(kDt, 1);
  BOOST_TEST((run.state().position(0) - Vec3(0, 0, 0.1)).norm() < 1e-12);
  run.run(kDt, 10);
  BOOST_TEST(run.state().position(0).z() > 0.101);
}

BOOST_AUTO_TEST_SUITE_END()
