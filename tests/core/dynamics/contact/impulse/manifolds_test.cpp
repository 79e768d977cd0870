// Impulses stay with the corner that bore them, however the body turns between two updates.
#include "core/dynamics/contact/impulse/manifolds.h"

#include <map>
#include <numbers>

#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_impulse_manifolds)

// After a quarter of a turn each corner stands where another one stood.
BOOST_AUTO_TEST_CASE(an_impulse_goes_with_its_corner_and_not_with_its_place) {
  Scene scene = on_floor({solid("box", Box{{1, 1, 1}}, {0, 0, 0.5})}, {0, 0.5});
  BodyTable before(scene.bodies.size()), after(scene.bodies.size());
  set_initial_state(scene, before.columns());
  scene.bodies[0].orientation = rotation_by({0, 0, 0.5 * std::numbers::pi});
  set_initial_state(scene, after.columns());
  ThreadPool alone(1);
  Manifolds manifolds(scene, alone);
  std::map<std::uint32_t, double> impulses;  // N s, by corner
  for (ContactConstraint& point : manifolds.find(std::as_const(before).columns(), 1.0 / 240)) {
    point.normal_impulse = 1 + static_cast<double>(impulses.size());
    point.friction_impulse = {0, point.normal_impulse, 0};
    impulses[point.feature] = point.normal_impulse;
  }
  BOOST_TEST_REQUIRE(impulses.size() == 4u);
  const auto& found = manifolds.find(std::as_const(after).columns(), 1.0 / 240);
  BOOST_TEST_REQUIRE(found.size() == 4u);
  for (const ContactConstraint& point : found) {
    BOOST_TEST(point.normal_impulse == impulses.at(point.feature));
    BOOST_TEST((point.friction_impulse == Vec3(0, impulses.at(point.feature), 0)));
  }
}

BOOST_AUTO_TEST_SUITE_END()
