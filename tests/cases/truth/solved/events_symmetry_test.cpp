// The truth by events under exact symmetries, beside tests/relations/. A scene whose outcome depends on a tie must be
// named.
#include <cmath>

#include "cases/truth/solved/events/equivalent_scene.h"
#include "tests/cases/judged.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"
#include "tests/relations/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_events_symmetry)

namespace {

// A ball that comes along x at 1 m/s to two that rest beside each other, 0.1 m off its line on either side.
Scene ball_to_two(double restitution) {
  Scene scene;
  scene.contact_default = {restitution, 0};
  for (const double y : {0.1, -0.1}) scene.bodies.push_back(test::on_its_own("", Sphere{0.1}, 1, {0.5, y, 0}));
  scene.bodies.push_back(test::on_its_own("cue", Sphere{0.1}, 1, {0, 0, 0}));
  scene.bodies[0].name = "left", scene.bodies[1].name = "right";
  scene.bodies[2].velocity = {1, 0, 0};
  return scene;
}

// A ball that falls into the groove of two planes, each at `angle` to the horizontal.
Scene ball_in_groove(double angle, double restitution) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.contact_default = {restitution, 0};
  scene.bodies = {test::on_its_own("ball", Sphere{0.1}, 1, {0, 0, 0.5}),
                  test::plane({std::sin(angle), 0, std::cos(angle)}),
                  test::plane({-std::sin(angle), 0, std::cos(angle)})};
  scene.bodies[1].name = "west", scene.bodies[2].name = "east";
  return scene;
}

}  // namespace

// The truth is found in the scene's own units, so that powers of two leave it but for roundings: 5e-13 measured.
BOOST_AUTO_TEST_CASE(powers_of_two_change_nothing_but_roundings) {
  Equivalence how;
  how.length = 0x1p3, how.time = 0x1p-2;
  const Scene scene = test::once_contradicted(3);
  const auto here = make_truth("events", scene, 1), there = make_truth("events", equivalent(scene, how), how.time);
  for (const double t : {0.25, 0.5, 1.0}) {
    const BodyTable a = test::truth_at(*here, t, 2), b = test::truth_at(*there, t * how.time, 2);
    BOOST_TEST((a.columns().position(0) * how.length - b.columns().position(0)).norm() < 1e-11);
    BOOST_TEST((a.columns().orientation(0).coeffs() - b.columns().orientation(0).coeffs()).norm() < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(a_tie_that_decides_is_named_and_no_small_error_is_claimed_beyond_it) {
  const auto truth = make_truth("events", ball_to_two(1), 2);
  const double meeting = 0.5 - 0.1 * std::sqrt(3);  // s
  for (const char* word : {"0.3268 s", "'left'", "'right'", "'cue'", "meets first"})
    BOOST_TEST(truth->caveat().find(word) != std::string::npos, word << ": " << truth->caveat());
  BOOST_TEST(truth->error(meeting - 0.01) < 1e-8);
  BOOST_TEST(truth->error(meeting + 0.1) >= 1);
  BOOST_TEST(make_truth("events", ball_in_groove(0.4, 0.5), 1)->caveat() != "");
}

BOOST_AUTO_TEST_CASE(a_tie_that_decides_nothing_is_not_named) {
  Scene flat;
  flat.gravity = {0, 0, -9.81};
  flat.contact_default = {0.5, 0.5};
  flat.bodies = {test::on_its_own("box", Box{{0.4, 0.3, 0.2}}, 1, {0, 0, 0.5}), test::plane()};
  flat.bodies[0].velocity = {0.3, 0.1, 0};
  Scene two = flat;  // that do not meet
  two.bodies.push_back(two.bodies[0]), two.bodies[2].position.x() = 3;
  // The two normals are at right angles, or nothing rebounds and each plane pushes the ball towards the other.
  for (const Scene& scene : {flat, two, ball_in_groove(0.25 * std::numbers::pi, 0.5), ball_in_groove(1, 0)}) {
    const auto truth = make_truth("events", scene, 0.8);
    BOOST_TEST(truth->caveat() == "");
    BOOST_TEST(truth->error(0.8) < 1e-7);
  }
}

BOOST_AUTO_TEST_SUITE_END()
