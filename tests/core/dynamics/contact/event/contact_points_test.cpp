// A contact is identified by its features, not by its place. A box that rotates on the spot comes to stand with another
// corner at the place of each one.
#include "core/dynamics/contact/event/contact_points.h"

#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_contact_points)

BOOST_AUTO_TEST_CASE(a_corner_is_followed_to_where_it_has_turned) {
  const QuarterTurn box;
  ContactPoints points(box.scene);
  std::vector<ContactPoint> touching;
  points.find(box.before.columns(), points.candidates(box.before.columns()), 1e-9, touching);
  BOOST_TEST_REQUIRE(touching.size() == 4u);
  for (ContactPoint& contact : touching) {
    const bool box_is_first = contact.cone.a == 0;
    const Vec3 was = box_is_first ? contact.cone.arm_a : contact.cone.arm_b;
    BOOST_TEST(points.follow(box.after.columns(), contact));
    const Vec3 is = box_is_first ? contact.cone.arm_a : contact.cone.arm_b;
    BOOST_TEST((is - box.turn * was).norm() < 1e-15, "from " << was.transpose() << " to " << is.transpose());
  }
}

BOOST_AUTO_TEST_SUITE_END()
