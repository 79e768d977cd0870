#include "cases/report/wording/explanations/explanation.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "cases/analysis/small_motions/stiffest_frequency.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_explanation)

namespace {

Body block(double mass, const Vec3& position, double inertia = 1) {
  Body body;
  body.name = "block", body.mass = mass, body.position = position;
  body.inertia = inertia * Mat3::Identity();
  return body;
}

Spring spring(int a, const Vec3& point_a, int b, const Vec3& point_b, double stiffness) {
  return {a, b, point_a, point_b, stiffness, 0, 1};
}

constexpr double kRounding = 1e-9;  // of a power method that has settled

}  // namespace

BOOST_AUTO_TEST_CASE(a_mass_on_a_spring_swings_at_root_k_over_m) {
  Scene scene;
  scene.bodies = {block(4, Vec3(0, 1, 0))};
  scene.springs = {spring(kWorld, Vec3(0, 2, 0), 0, Vec3::Zero(), 100)};
  BOOST_TEST(stiffest_frequency(scene) == 5, boost::test_tools::tolerance(kRounding));
}

BOOST_AUTO_TEST_CASE(two_masses_swing_at_root_k_over_the_reduced_mass) {
  Scene scene;
  scene.bodies = {block(3, Vec3(0, 0, 0)), block(6, Vec3(1, 0, 0))};  // reduced mass 2
  scene.springs = {spring(0, Vec3::Zero(), 1, Vec3::Zero(), 50)};
  BOOST_TEST(stiffest_frequency(scene) == 5, boost::test_tools::tolerance(kRounding));
}

BOOST_AUTO_TEST_CASE(an_arm_lets_a_spring_turn_the_body) {
  // 1/m + r²/I = 1/2 + 4/8 = 1 for a spring along y at r = 2 along x.
  Scene scene;
  scene.bodies = {block(2, Vec3::Zero(), 8)};
  scene.springs = {spring(kWorld, Vec3(2, 5, 0), 0, Vec3(2, 0, 0), 9)};
  BOOST_TEST(stiffest_frequency(scene) == 3, boost::test_tools::tolerance(kRounding));
}

BOOST_AUTO_TEST_CASE(springs_side_by_side_add_up) {
  Scene scene;
  scene.bodies = {block(4, Vec3(0, 1, 0))};
  scene.springs = {spring(kWorld, Vec3(0, 2, 0), 0, Vec3::Zero(), 60),
                   spring(kWorld, Vec3(0, 3, 0), 0, Vec3::Zero(), 40)};
  BOOST_TEST(stiffest_frequency(scene) == 5, boost::test_tools::tolerance(kRounding));
}

BOOST_AUTO_TEST_CASE(without_springs_that_move_anything_there_is_no_frequency) {
  Scene scene;
  BOOST_TEST(stiffest_frequency(scene) == 0);
  scene.bodies = {block(4, Vec3(0, 1, 0))};
  scene.bodies.front().fixed = true;
  scene.springs = {spring(kWorld, Vec3(0, 2, 0), 0, Vec3::Zero(), 60)};
  BOOST_TEST(stiffest_frequency(scene) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
