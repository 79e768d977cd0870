// The sliders: which a scene has, and what they change in it.
#include "cases/laboratory/knobs.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "tests/scenes.h"

BOOST_AUTO_TEST_SUITE(cases_laboratory_knobs)

namespace {

using namespace rigor;
using namespace rigor::test;

std::vector<std::string> names_in(const Scene& scene) {
  std::vector<std::string> names;
  for (const Knob& knob : knobs_of(scene)) names.push_back(knob.name);
  return names;
}

std::string refusal(const Scene& scene, const KnobValues& values) {
  try {
    with_knobs(scene, values);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_scene_has_the_knobs_that_mean_something_in_it) {
  const std::vector<std::string> of_spring = {"stiffness", "damping", "mass", "gravity"};
  BOOST_TEST(names_in(fixed_spring()) == of_spring, boost::test_tools::per_element());
  const std::vector<std::string> of_top = {"mass"};
  BOOST_TEST(names_in(tumbling_body()) == of_top, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(contacts_have_restitution_and_friction) {
  Scene scene = fixed_spring();
  scene.springs.clear();
  scene.bodies[0].shape = Sphere{0.1}, scene.bodies[0].collides = true;
  Body ground;
  ground.name = "ground", ground.fixed = true, ground.shape = Plane{{0, 1, 0}, 0}, ground.collides = true;
  scene.bodies.push_back(ground);
  scene.contact_pairs = {{0, 1, {.restitution = 0.5, .friction = kInfiniteFriction}}};
  const std::vector<std::string> expected = {"mass", "restitution", "friction", "gravity"};
  BOOST_TEST(names_in(scene) == expected, boost::test_tools::per_element());
  const Scene changed = with_knobs(scene, {{"restitution", 1}, {"friction", 0.25}});
  BOOST_TEST(changed.contact_pairs[0].law.restitution == 1);
  BOOST_TEST(changed.contact_pairs[0].law.friction == 0.25);
  BOOST_TEST(with_knobs(changed, {{"friction", HUGE_VAL}}).contact_pairs[0].law.friction == kInfiniteFriction);
}

BOOST_AUTO_TEST_CASE(a_knob_changes_all_rows_in_proportion_and_nothing_else) {
  const Scene scene = coupled_bodies(0);
  const Scene changed = with_knobs(scene, {{"stiffness", 120}, {"mass", 1}, {"gravity", 4.905}});
  BOOST_TEST(changed.springs[0].stiffness == 120);
  BOOST_TEST(changed.springs[1].stiffness == 80);
  BOOST_TEST(changed.bodies[0].mass == 1);
  BOOST_TEST(changed.bodies[1].mass == 0.5);
  BOOST_TEST((changed.bodies[1].inertia == 0.5 * scene.bodies[1].inertia));
  BOOST_TEST((changed.gravity == Vec3(0, 0, -4.905)));
  BOOST_TEST(changed.springs[0].rest_length == scene.springs[0].rest_length);
}

BOOST_AUTO_TEST_CASE(its_own_values_leave_a_scene_as_it_is_bit_by_bit) {
  const Scene scene = coupled_bodies(3);
  KnobValues own;
  for (const Knob& knob : knobs_of(scene)) own[knob.name] = knob.value;
  const Scene same = with_knobs(scene, own);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    BOOST_TEST(same.bodies[i].mass == scene.bodies[i].mass);
    BOOST_TEST((same.bodies[i].inertia == scene.bodies[i].inertia));
  }
  for (std::size_t i = 0; i < scene.springs.size(); ++i)
    BOOST_TEST(same.springs[i].stiffness == scene.springs[i].stiffness);
  BOOST_TEST((same.gravity == scene.gravity));
}

BOOST_AUTO_TEST_CASE(wrong_knobs_are_refused_with_what_is_allowed) {
  BOOST_TEST(refusal(fixed_spring(), {{"stifness", 1}}) ==
             "the scene has no knob 'stifness' (did you mean 'stiffness'?); it has: stiffness, damping, mass, gravity");
  BOOST_TEST(refusal(fixed_spring(), {{"gravity", -1}}) == "gravity: found -1; allowed: 0 to 30 m/s²");
  BOOST_TEST(refusal(fixed_spring(), {{"mass", HUGE_VAL}}) == "mass: found inf; allowed: 1 to 10000 kg");
  BOOST_TEST(!refusal(fixed_spring(), {{"mass", std::nan("")}}).empty());
}

BOOST_AUTO_TEST_SUITE_END()
