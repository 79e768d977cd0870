#include "core/scene/contact_laws.h"

#include <boost/test/unit_test.hpp>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_contact_laws)

BOOST_AUTO_TEST_CASE(every_pair_has_the_law_that_the_scene_gives_it) {
  Scene scene;
  scene.bodies.resize(5);
  scene.contact_default = {0.1, 0.2};
  scene.contact_pairs = {{0, 1, {0.3, 0.4}}, {4, 2, {0.5, kInfiniteFriction}}, {1, 0, {0.6, 0.7}}};
  const ContactLaws laws(scene);
  for (int a = 0; a < 5; ++a) {
    for (int b = 0; b < 5; ++b) {
      BOOST_TEST(laws.of(a, b).restitution == scene.contact_law(a, b).restitution);
      BOOST_TEST(laws.of(a, b).friction == scene.contact_law(a, b).friction);
    }
  }
}

BOOST_AUTO_TEST_CASE(two_bodies_can_touch_if_both_collide_and_one_can_move) {
  Scene scene;
  scene.bodies.resize(2);
  BOOST_TEST(!anything_can_touch(scene));
  scene.bodies[0].collides = true;
  BOOST_TEST(!anything_can_touch(scene));
  scene.bodies[1].collides = true;
  BOOST_TEST(anything_can_touch(scene));
  scene.bodies[0].fixed = scene.bodies[1].fixed = true;
  BOOST_TEST(!anything_can_touch(scene));
}

BOOST_AUTO_TEST_CASE(a_pair_that_never_touches_is_found_in_either_order_and_counts_as_no_contact) {
  Scene scene;
  scene.bodies.resize(3);
  for (Body& body : scene.bodies) body.collides = true;
  scene.bodies[2].fixed = true;
  scene.contact_pairs = {{1, 0, kApart}, {0, 2, kApart}};
  const ContactLaws laws(scene);
  BOOST_TEST((laws.some_are_apart() && !laws.may_touch(0, 1) && !laws.may_touch(2, 0) && laws.may_touch(1, 2)));
  BOOST_TEST(anything_can_touch(scene));
  scene.contact_pairs.push_back({1, 2, kApart});
  BOOST_TEST(!anything_can_touch(scene));
}

BOOST_AUTO_TEST_SUITE_END()
