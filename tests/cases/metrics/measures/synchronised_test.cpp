// Velocities brought to the positions' time: by what acts on a body that is free, and along what joints allow.
#include "cases/metrics/measures/synchronised.h"

#include <boost/test/unit_test.hpp>

#include "cases/metrics/measures/joints/joint_geometry.h"
#include "tests/cases/judged.h"

using namespace rigor;

namespace {

BodyTable start_of(const Scene& scene) {
  BodyTable bodies(scene.bodies.size());
  set_initial_state(scene, bodies.columns());
  return bodies;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_synchronised)

BOOST_AUTO_TEST_CASE(a_free_body_gains_what_acts_in_half_a_step_and_a_fixed_one_nothing) {
  Scene scene = test::tumbling_body({1, 1, 1});
  scene.gravity = {0, 0, -10};
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].fixed = true, scene.bodies[1].velocity.setZero(), scene.bodies[1].angular_velocity.setZero();
  scene.forces = {{.body = 0, .torque = {2, 0, 0}, .until = 1}};
  BodyTable bodies = start_of(scene);
  Synchroniser(scene, 0.2, 0.5).apply(0.5, bodies.columns());
  const BodyState was = start_of(scene).columns().body(0);
  BOOST_TEST((bodies.columns().velocity(0) - was.velocity - Vec3(0, 0, -1)).norm() < 1e-15);
  BOOST_TEST((bodies.columns().angular_velocity(0) - was.angular_velocity - Vec3(0.2, 0, 0)).norm() < 1e-15);
  BOOST_TEST(bodies.columns().velocity(1).norm() + bodies.columns().angular_velocity(1).norm() == 0);
  bodies = start_of(scene);
  Synchroniser(scene, 0.2, 0).apply(0.5, bodies.columns());
  BOOST_TEST(bodies.columns().velocity(0) == was.velocity);
}

// A rod of 1 m that hangs and swings at 3 rad/s: gravity alone would pull its middle off the circle, by g dt/2.
BOOST_AUTO_TEST_CASE(a_jointed_body_keeps_to_its_joint) {
  Scene scene;
  scene.gravity = {0, -10, 0};
  scene.bodies = {test::body("rod", 1, {1.0 / 12, 0.001, 1.0 / 12}, {0, -0.5, 0})};
  scene.bodies[0].velocity = {1.5, 0, 0}, scene.bodies[0].angular_velocity = {0, 0, 3};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}}};
  BodyTable bodies = start_of(scene);
  Synchroniser(scene, 0.1, 0.5).apply(0, bodies.columns());
  const JointGeometry joint(scene, scene.joints[0]);
  BOOST_TEST(joint.gap_rate(bodies.columns()) < 1e-14);  // roundings; g dt/2 is 0.5 m/s
  BOOST_TEST((bodies.columns().velocity(0) - Vec3(1.5, 0, 0)).norm() < 1e-14);
}

BOOST_AUTO_TEST_SUITE_END()
