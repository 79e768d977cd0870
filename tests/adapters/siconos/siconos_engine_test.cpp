// Siconos in its own process: the process, the properties of its contact law, and its known traps.
#include "adapters/siconos/siconos_engine.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <numbers>

#include "core/dynamics/model/energy.h"
#include "tests/adapters/free_body_measures.h"
#include "tests/adapters/hung_rods.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_siconos_siconos_engine)

namespace {

constexpr double kHalfTurn = std::numbers::pi;

bool is_mapped(const std::string& library) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (line.find(library) != std::string::npos) return true;
  return false;
}

}  // namespace

// Bullet in single precision crashes beside ours: nothing that brings it may come here.
BOOST_AUTO_TEST_CASE(neither_its_libraries_nor_their_bullet_come_into_this_process) {
  const auto world = load_run("siconos", sliding_box(1, 0, 0.5));
  body_after(*world, 1.0 / 240, 10);
  BOOST_TEST(is_mapped("libBulletCollision-float64"));  // ours is, so that the next lines can fail
  BOOST_TEST(!is_mapped("libsiconos"));
  BOOST_TEST(!is_mapped("libBulletCollision.so"));
}

// A pyramid brakes with 1.41 of the force along its diagonal. A step of first order is half a step of v0 short, .5 %.
BOOST_AUTO_TEST_CASE(friction_is_a_cone) {
  const double along = stop_distance_ratio("siconos", 0, 1.0 / 240);
  BOOST_TEST(std::abs(along - 1) < 0.006, along);
  for (const double direction : {kHalfTurn / 8, kHalfTurn / 4, kHalfTurn / 3}) {
    const double found = stop_distance_ratio("siconos", direction, 1.0 / 240);
    // In the last step, which it stops in, it has 0.02 m/s at most: 2 v dt of the 2.5 m are 7e-5.
    BOOST_TEST(std::abs(found - along) < 1e-4, direction << ": " << found);
  }
}

// Below 2e-3 rad in a step a turn is an eighth of its cube too far: RotationQuaternion.cpp, sin_x.
BOOST_AUTO_TEST_CASE(small_turns_go_too_far) {
  Scene scene = asymmetric_top();
  scene.bodies[0].angular_velocity = {0.4, 0, 0};
  const int steps = 2400;
  const auto error_at = [&](double dt) {
    const auto world = load_run("siconos", scene);
    const BodyState found = body_after(*world, dt, steps);
    return angle_between(found.orientation, rotation_by(steps * dt * scene.bodies[0].angular_velocity));
  };
  const double turn = 0.4 / 240;
  BOOST_TEST(std::abs(error_at(1.0 / 240) / (steps * turn * turn * turn / 8) - 1) < 1e-3);  // the series' next term
  BOOST_TEST(error_at(1.0 / 120) < 1e-10);  // roundings of as many steps; 3.3e-3 rad each is no small turn
}

// Velocities are taken to where the joint is at the step's end, h w^2 / 2 of the energy at a time.
BOOST_AUTO_TEST_CASE(a_jointed_body_loses_energy_at_coarse_steps_and_less_at_fine_ones) {
  Joint hinge{.a = kWorld, .b = 0, .type = HingeJoint{{0, 0, 0}, {0, 1, 0}}};
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {rod("rod", {0.5, 0, 0})};
  scene.joints = {hinge};
  const auto lost = [&](double dt) {  // of the energy that it falls by, after 2 s
    const auto world = load_run("siconos", scene);
    Snapshot snapshot;
    world->read(snapshot);
    const double before = energy(scene, snapshot.bodies());
    body_after(*world, dt, static_cast<int>(std::lround(2 / dt)));
    world->read(snapshot);
    return (before - energy(scene, snapshot.bodies())) / (scene.bodies[0].mass * 9.81 * 0.5);
  };
  const double coarse = lost(1.0 / 30), fine = lost(1.0 / 240);
  BOOST_TEST_MESSAGE("a pendulum loses " << coarse << " at 1/30 s and " << fine << " at 1/240 s");
  BOOST_TEST(coarse > 0.2);
  BOOST_TEST((fine > 0.01 && fine < coarse / 4));  // of first order: an eighth, but for the larger swings
}

// An iteration that ends before its tolerance is no step of the method, and says so.
BOOST_AUTO_TEST_CASE(what_the_contact_solver_did_not_reach_is_told) {
  const auto cut_short = load_run("siconos,iterations=1,tolerance=1e-15", sliding_box(1, 0.3, 0.5));
  body_after(*cut_short, 1.0 / 240, 5);
  BOOST_TEST(cut_short->solver_warning().find("tolerance") != std::string::npos);
  const auto whole = load_run("siconos", sliding_box(1, 0.3, 0.5));
  body_after(*whole, 1.0 / 240, 5);
  BOOST_TEST(whole->solver_warning() == "");
}

// A corner whose gap is a rounding above 0 takes no part in a step of Siconos as shipped, and the box falls there.
BOOST_AUTO_TEST_CASE(a_box_at_rest_is_carried_from_the_first_step_on) {
  const Scene scene = sliding_box(0, 0, 0.5);
  const double weight = scene.bodies[0].mass * scene.gravity.norm();
  for (const double dt : {1.0 / 30, 1.0 / 240, 1.0 / 1000}) {
    const auto world = load_run("siconos", scene);
    ReportsContacts& reports = *world->capabilities().contacts;
    reports.ask_for_contacts();
    for (int n = 0; n < 8; ++n) {
      world->step(dt);
      Vec3 sum = Vec3::Zero();
      for (const ReportedContact& contact : reports.contacts())
        sum += contact.b == 0 ? contact.force : Vec3(-contact.force);
      // Its solver's tolerance is 1e-12 of the impulses.
      BOOST_TEST((sum + scene.bodies[0].mass * scene.gravity).norm() < 1e-9 * weight, dt << " " << n);
    }
  }
}

BOOST_AUTO_TEST_CASE(what_it_cannot_do_is_refused_with_the_reason) {
  Scene scene = sliding_box(1, 0, kInfiniteFriction);
  const std::string why = why_unsupported(engines().info_of("siconos"), scene, 1e-3);
  BOOST_TEST(why.find("friction:infinite") != std::string::npos, why);
}

BOOST_AUTO_TEST_SUITE_END()
