// Impulses stay with the corner that bore them, however the body turns between two updates.
#include "core/dynamics/contact/impulse/manifolds.h"

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

BOOST_AUTO_TEST_SUITE_END()
