// Impulses stay with the corner that bore them, however the body turns between two updates.
#include "core/dynamics/contact/impulse/manifolds.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_impulse_manifolds)

BOOST_AUTO_TEST_CASE(an_impulse_goes_with_its_corner_and_not_with_its_place) {
  const QuarterTurn box;
  ThreadPool alone(1);
  Manifolds manifolds(box.scene, alone);
  std::map<std::uint32_t, double> impulses;  // N s, by corner
  for (ContactConstraint& point : manifolds.find(box.before.columns(), 1.0 / 240)) {
    point.normal_impulse = 1 + static_cast<double>(impulses.size());
    point.friction_impulse = {0, point.normal_impulse, 0};
    impulses[point.feature] = point.normal_impulse;
  }
  BOOST_TEST_REQUIRE(impulses.size() == 4u);
  const auto& found = manifolds.find(box.after.columns(), 1.0 / 240);
  BOOST_TEST_REQUIRE(found.size() == 4u);
  for (const ContactConstraint& point : found) {
    BOOST_TEST(point.normal_impulse == impulses.at(point.feature));
    BOOST_TEST((point.friction_impulse == Vec3(0, impulses.at(point.feature), 0)));
  }
}

// Two cubes rest on each other, one turned a little about the vertical. Their nearly parallel edges cross anywhere
// along the face. The four points must still be at its four corners, or an impulse is lost and the upper cube is
// kicked.
BOOST_AUTO_TEST_CASE(four_points_of_a_turned_cube_are_its_corners) {
  Scene scene;
  scene.bodies = {solid("lower", Box{{0.2, 0.2, 0.2}}, {0, 0, 0.1}),
                  solid("upper", Box{{0.2, 0.2, 0.2}}, {0, 0, 0.3 - 4e-6})};
  ThreadPool alone(1);
  for (const double turn : {1e-4, 4e-4, -3e-3}) {
    for (const Vec3& aside : {Vec3(0, 0, 0), Vec3(1e-5, 3e-5, 0), Vec3(-3e-5, 8e-6, 0)}) {
      scene.bodies[1].orientation = Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
      scene.bodies[1].position = Vec3(0, 0, 0.3 - 4e-6) + aside;
      BodyTable state(2);
      set_initial_state(scene, state.columns());
      Manifolds manifolds(scene, alone);
      const auto& points = manifolds.find(state.columns(), 1.0 / 960);
      BOOST_TEST_REQUIRE(points.size() == 4u);
      int quadrants = 0;
      for (const ContactConstraint& point : points) {
        BOOST_TEST(std::min(std::abs(point.arm_a.x()), std::abs(point.arm_a.y())) > 0.09);
        quadrants |= 1 << ((point.arm_a.x() > 0 ? 1 : 0) + (point.arm_a.y() > 0 ? 2 : 0));
      }
      BOOST_TEST(quadrants == 15, "turned by " << turn << ", aside by " << aside.transpose());
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
