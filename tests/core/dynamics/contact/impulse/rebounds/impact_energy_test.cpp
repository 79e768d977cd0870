// No impact of jointed bodies adds energy: exactly the excess of Newton's restitution is taken back.
#include "core/dynamics/contact/impulse/rebounds/impact_energy.h"

#include <boost/test/unit_test.hpp>
#include <random>

#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/contact/contact_runs.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_impulse_rebounds_impact_energy)

namespace {

Scene two_bodies() {
  Scene scene;
  scene.bodies = {test::body("a", 2, {1, 2, 3}), test::body("b", 0.5, {0.1, 0.2, 0.25}, {1, 0, 0})};
  scene.bodies[1].orientation = Quat(0.8, 0.1, -0.5, 0.3).normalized();
  return scene;
}

std::vector<Vec6> scaled(std::vector<Vec6> velocities, double by) {
  for (Vec6& v : velocities) v *= by;
  return velocities;
}

// Two bars on a ball joint, one lying on its end and both falling on the ground with a turn: each hits at two points,
// with friction.
Scene falling_pair(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> some(-1, 1);
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  const double tilt = 0.6 * some(random);
  const Vec3 along(std::cos(tilt), std::sin(tilt), 0);
  for (int i = 0; i < 2; ++i) {
    Body bar = test::solid(i == 0 ? "first" : "second", Box{{0.4, 0.06, 0.06}}, 0.4 * i * along + Vec3(0, 0.35, 0), 1);
    bar.orientation = rotation_by(Vec3(0, 0, tilt));
    scene.bodies.push_back(bar);
  }
  const Vec3 turn(0, 0, 4 * some(random)), speed(2 * some(random), -1, 0);
  for (Body& bar : scene.bodies) {
    bar.angular_velocity = turn;
    bar.velocity = speed + turn.cross(bar.position - scene.bodies[0].position);
  }
  scene.joints = {{0, 1, HingeJoint{scene.bodies[0].position + 0.2 * along, Vec3::UnitZ()}}};
  Body plane;
  plane.name = "ground", plane.shape = Plane{Vec3::UnitY(), 0};
  plane.fixed = plane.collides = true;
  scene.bodies.push_back(plane);
  scene.contact_default = {1, 0.7};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_has_too_much_goes_back_towards_what_has_less_until_it_has_as_much) {
  const Scene scene = two_bodies();
  const System system(scene);
  BodyTable pose(scene.bodies.size());
  set_initial_state(scene, pose.columns());
  std::vector<Vec6> without(2), with(2);
  without[0] << 1, 0.5, -0.3, 0.1, 0.2, -0.4, without[1] << -0.2, 0.7, 0.1, 1.5, -2, 0.3;
  with[0] << 2, -0.5, 1, 0.8, 0.1, 0.6, with[1] << 1.2, 2.7, -0.1, -2.5, 1, 3;
  const double least = twice_energy_of(system, pose.columns(), without),
               most = twice_energy_of(system, pose.columns(), with);
  BOOST_TEST_REQUIRE(least < 0.5 * most);
  for (const double allowed : {0.5 * most, 0.9 * most}) {
    std::vector<Vec6> limited = with;
    limit_energy(system, pose.columns(), allowed, without, limited);
    BOOST_TEST(twice_energy_of(system, pose.columns(), limited) == allowed, boost::test_tools::tolerance(1e-14));
    // On the line between the two: all components have gone the same share of the way.
    const double share = (limited[0][0] - without[0][0]) / (with[0][0] - without[0][0]);
    BOOST_TEST((share > 0 && share < 1));
    for (int i = 0; i < 2; ++i) BOOST_TEST((limited[i] - (without[i] + share * (with[i] - without[i]))).norm() < 1e-14);
  }
  // A body with no more energy than allowed stays unchanged. If even zero restitution gives too much, that result is
  // used.
  std::vector<Vec6> same = with;
  limit_energy(system, pose.columns(), most, without, same);
  BOOST_TEST((same[0] == with[0] && same[1] == with[1]));
  limit_energy(system, pose.columns(), 0.5 * least, without, same);
  BOOST_TEST((same[0] == without[0] && same[1] == without[1]));
  // A limit of a body at rest, all energy to be taken.
  std::vector<Vec6> still = with;
  limit_energy(system, pose.columns(), 0, scaled(without, 0), still);
  BOOST_TEST(twice_energy_of(system, pose.columns(), still) == 0);
}

// Perfectly elastic, with friction. Newton's rule may give any result for the points together. The energy rises in no
// step by more than position correction allows, a slop of 1e-3 m of the weight.
BOOST_AUTO_TEST_CASE(no_impact_of_a_jointed_pair_adds_energy) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const Scene scene = falling_pair(seed);
    const auto world = CoreEngine().load(scene, {.method = "rk4", .options = {{"contact", "impulse"}}});
    Snapshot now;
    world->read(now);
    const double start = energy(scene, now.bodies());
    double highest = start;
    for (int n = 0; n < 240; ++n) {
      world->step(1.0 / 240), world->read(now);
      highest = std::max(highest, energy(scene, now.bodies()));
    }
    BOOST_TEST_CONTEXT("seed " << seed) BOOST_TEST(highest - start < 2 * 9.81 * 1e-3);
  }
}

BOOST_AUTO_TEST_SUITE_END()
