// A contact is followed by what touches, and not by where: a box that turns on the spot comes to stand with another
// corner where each one stood.
#include "core/dynamics/contact/event/contact_points.h"

#include <numbers>

#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_contact_points)

BOOST_AUTO_TEST_CASE(a_corner_is_followed_to_where_it_has_turned) {
  Scene scene = on_floor({solid("box", Box{{1, 1, 1}}, {0, 0, 0.5})}, {0, 0.5});
  BodyTable before(scene.bodies.size()), after(scene.bodies.size());
  set_initial_state(scene, before.columns());
  const Quat turn = rotation_by({0, 0, 0.5 * std::numbers::pi});
  scene.bodies[0].orientation = turn;
  set_initial_state(scene, after.columns());
  ContactPoints points(scene);
  std::vector<ContactPoint> touching;
  points.find(std::as_const(before).columns(), points.candidates(std::as_const(before).columns()), 1e-9, touching);
  BOOST_TEST_REQUIRE(touching.size() == 4u);
  for (ContactPoint& contact : touching) {
    const bool box_is_first = contact.cone.a == 0;
    const Vec3 was = box_is_first ? contact.cone.arm_a : contact.cone.arm_b;
    BOOST_TEST(points.follow(std::as_const(after).columns(), contact));
    const Vec3 is = box_is_first ? contact.cone.arm_a : contact.cone.arm_b;
    BOOST_TEST((is - turn * was).norm() < 1e-15, "from " << was.transpose() << " to " << is.transpose());
  }
}

BOOST_AUTO_TEST_SUITE_END()
