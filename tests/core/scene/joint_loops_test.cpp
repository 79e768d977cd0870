#include "core/scene/joint_loops.h"

#include <boost/test/unit_test.hpp>

#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_joint_loops)

namespace {

// Balls between these pairs of bodies; body `fixed` stands.
Scene linked(int bodies, const std::vector<std::pair<int, int>>& pairs, int fixed = -2) {
  Scene scene;
  for (int i = 0; i < bodies; ++i) scene.bodies.push_back(test::body("b" + std::to_string(i), 1, {1, 1, 1}));
  if (fixed >= 0) scene.bodies[static_cast<std::size_t>(fixed)].fixed = true;
  for (const auto& [a, b] : pairs) scene.joints.push_back({.a = a, .b = b, .type = BallJoint{Vec3::Zero()}});
  return scene;
}

using Flags = std::vector<bool>;

}  // namespace

BOOST_AUTO_TEST_CASE(chains_and_trees_have_no_loop) {
  BOOST_TEST(joints_on_loops(linked(3, {{kWorld, 0}, {0, 1}, {1, 2}})) == (Flags{false, false, false}));
  BOOST_TEST(joints_on_loops(linked(4, {{0, 1}, {0, 2}, {0, 3}})) == (Flags{false, false, false}));
}

BOOST_AUTO_TEST_CASE(a_loop_through_the_world_or_a_fixed_body_is_one) {
  BOOST_TEST(joints_on_loops(linked(3, {{kWorld, 0}, {0, 1}, {1, 2}, {2, kWorld}})) == (Flags(4, true)));
  BOOST_TEST(joints_on_loops(linked(3, {{kWorld, 0}, {0, 1}, {1, 2}}, 2)) == (Flags(3, true)));
}

BOOST_AUTO_TEST_CASE(a_joint_between_two_loops_and_one_that_hangs_on_a_loop_are_on_none) {
  const Scene scene = linked(7, {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}, {4, 5}, {5, 3}, {5, 6}});
  BOOST_TEST(joints_on_loops(scene) == (Flags{true, true, true, false, true, true, true, false}));
}

BOOST_AUTO_TEST_CASE(two_joints_of_the_same_bodies_are_a_loop) {
  BOOST_TEST(joints_on_loops(linked(2, {{kWorld, 0}, {0, 1}, {1, 0}})) == (Flags{false, true, true}));
}

BOOST_AUTO_TEST_SUITE_END()
