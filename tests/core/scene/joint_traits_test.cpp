#include "core/scene/joint_traits.h"

#include <boost/test/unit_test.hpp>

#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_joint_traits)

namespace {

// Bodies in a row, each on the one before, the first on the world.
Scene chain(int links) {
  Scene scene;
  for (int k = 0; k < links; ++k) {
    scene.bodies.push_back(test::body("link " + std::to_string(k), 1, {1, 1, 1}, {1.0 * k, 0, 0}));
    scene.joints.push_back({k == 0 ? kWorld : k - 1, k, HingeJoint{{k - 0.5, 0, 0}, {0, 0, 1}}});
  }
  return scene;
}

std::string traits(const Scene& scene) {
  std::string words;
  for (const Need& need : joint_traits_of(scene)) words += word_of(need.feature) + " ";
  return words;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_chain_has_no_loop_and_one_held_at_both_ends_has) {
  Scene scene = chain(3);
  BOOST_TEST(traits(scene) == "");
  scene.joints.push_back({2, kWorld, BallJoint{{2.5, 0, 0}}, "last"});
  BOOST_TEST(traits(scene) == "joint-loop ");
  BOOST_TEST(joint_traits_of(scene).front().because == "joint 'last'");
}

BOOST_AUTO_TEST_CASE(a_joint_doubled_is_a_loop) {
  Scene scene = chain(2);
  scene.joints.push_back(scene.joints.back());
  BOOST_TEST(traits(scene) == "joint-loop ");
}

BOOST_AUTO_TEST_CASE(a_fixed_body_is_the_world) {
  Scene scene = chain(3);
  scene.bodies.push_back(test::body("wall", 1, {1, 1, 1}, {3, 0, 0}));
  scene.joints.push_back({2, 3, BallJoint{{2.5, 0, 0}}});
  BOOST_TEST(traits(scene) == "");
  scene.bodies.back().fixed = true;
  BOOST_TEST(traits(scene) == "joint-loop ");
}

BOOST_AUTO_TEST_CASE(a_motor_that_keeps_a_speed_is_one_with_limits_only_on_a_joint_that_has_some) {
  Scene scene = chain(2);
  scene.motors = {{.joint = 1, .speed = 1, .most = 1}};
  scene.joints[0].upper = 1;
  BOOST_TEST(traits(scene) == "");
  scene.joints[1].upper = 1;
  BOOST_TEST(traits(scene) == "speed-motor-with-limits ");
  scene.motors[0].speed.reset();
  BOOST_TEST(traits(scene) == "");
}

BOOST_AUTO_TEST_CASE(two_speeds_of_a_joint_are_two_only_where_their_times_overlap) {
  Scene scene = chain(2);
  scene.motors = {{.joint = 1, .speed = 1, .most = 1, .until = 2}, {.joint = 1, .speed = 3, .most = 1, .from = 2}};
  BOOST_TEST(traits(scene) == "");
  scene.motors[1].from = 1.9;
  BOOST_TEST(traits(scene) == "two-speeds-at-once ");
  scene.motors[1].joint = 0;
  BOOST_TEST(traits(scene) == "");
}

BOOST_AUTO_TEST_SUITE_END()
