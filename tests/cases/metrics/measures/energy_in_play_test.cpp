// What a scene has in play, beside what mechanics says of it.
#include "cases/metrics/measures/energy_in_play.h"

#include <boost/test/unit_test.hpp>

#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_energy_in_play)

namespace {

const auto kClose = boost::test_tools::tolerance(1e-9);

Scene ball_over(double height, const Body& support) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("ball", Sphere{0.5}, 2, {0, 0, 0.5 + height}), support};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_body_over_a_plane_has_its_fall_and_its_start_in_play_however_long_the_run) {
  Scene scene = ball_over(3, test::plane());
  BOOST_TEST(energy_in_play(scene, 10) == 60, kClose);  // m g h
  BOOST_TEST(energy_in_play(scene, 1000) == 60, kClose);
  BOOST_TEST(energy_in_play(scene, 0.1) == 1, kClose);  // 1 m/s is all that it can gain in so short a time
  scene.bodies[0].velocity = {3, 0, 0};
  BOOST_TEST(energy_in_play(scene, 10) == 69, kClose);
}

BOOST_AUTO_TEST_CASE(what_can_neither_fall_nor_move_has_what_would_lift_it_by_half_its_thickness) {
  BOOST_TEST(energy_in_play(ball_over(0, test::plane()), 10) == 10, kClose);
  Scene afloat = ball_over(0, test::plane());
  afloat.gravity.setZero();
  BOOST_TEST(energy_in_play(afloat, 10) == 1);
  Scene point;  // what has no shape is not thick
  point.gravity = {0, 0, -10};
  point.bodies = {test::body("point", 2, {1, 1, 1})};
  BOOST_TEST(energy_in_play(point, 0) == 1);
}

BOOST_AUTO_TEST_CASE(a_slope_gives_what_sliding_down_it_without_friction_gives) {
  // 30°: touching, the ball gains g t / 2 along it.
  const Scene scene = test::on_slope(Sphere{0.5}, std::acos(-1) / 6, 0.4, 0);
  const double speed = 9.81 / 2 * 2;
  BOOST_TEST(energy_in_play(scene, 2) == 0.5 * 2 * speed * speed, kClose);
  // Half a metre above it, along its normal, it falls first.
  Scene above = scene;
  above.bodies[0].position *= 2;
  const double landing = std::sqrt(2 * 9.81 * 0.5 / std::sqrt(0.75)), both = landing + speed;
  BOOST_TEST(energy_in_play(above, 2) == 0.5 * 2 * both * both, kClose);
}

BOOST_AUTO_TEST_CASE(of_two_supports_the_higher_one_ends_the_fall_and_a_ceiling_none) {
  Scene scene = ball_over(3, test::plane());
  scene.bodies.push_back(test::plane(Vec3::UnitZ(), 1));
  scene.bodies.push_back(test::plane(-Vec3::UnitZ(), -20));
  BOOST_TEST(energy_in_play(scene, 10) == 40, kClose);
}

BOOST_AUTO_TEST_CASE(over_a_fixed_body_the_fall_ends_at_its_lowest_point_and_over_nothing_with_the_run) {
  Body shelf = test::on_its_own("shelf", Sphere{1}, 1, {0, 0, -1});
  shelf.fixed = true;
  BOOST_TEST(energy_in_play(ball_over(3, shelf), 10) == 2 * 10 * 5.5, kClose);
  Scene over_both = ball_over(3, shelf);
  over_both.bodies.push_back(test::plane());
  BOOST_TEST(energy_in_play(over_both, 10) == 60, kClose);  // a plane is all that counts
  shelf.collides = false;
  BOOST_TEST(energy_in_play(ball_over(3, shelf), 10) == 0.5 * 2 * 100 * 100, kClose);
}

BOOST_AUTO_TEST_CASE(what_hangs_by_springs_falls_no_further_than_they_let_it) {
  // Two weights of 1 kg in a chain of springs of 1 m and 400 N/m: 40 N, twice the whole weight is 80 N, stretch each by
  // 0.1 m. At rest the fall of the upper one is 0.1 m and that of the lower one twice that: 10 N · 0.3 m = 3 J.
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::body("upper", 1, {1, 1, 1}, {0, 0, -1}), test::body("lower", 1, {1, 1, 1}, {0, 0, -2})};
  scene.springs = {test::spring(0, {0, 0, 0}, 1, {0, 0, 0}, 400, 1),
                   test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 400, 1)};
  BOOST_TEST(energy_in_play(scene, 100) == 3, kClose);
  Scene held = scene;  // by a fixed body instead of the world
  held.bodies.push_back(test::body("ceiling", 1, {1, 1, 1}));
  held.bodies[2].fixed = true, held.springs[1].a = 2;
  BOOST_TEST(energy_in_play(held, 100) == 3, kClose);
  // The lower one by a point 0.2 m below the upper one's middle, at one 0.1 m above its own: as far below, if turned.
  scene.springs[0] = test::spring(0, {0, 0, -0.2}, 1, {0, 0, 0.1}, 400, 0.7);
  BOOST_TEST(energy_in_play(scene, 100) == 3, kClose);
  scene.springs.pop_back();  // tied to each other, and to nothing else
  BOOST_TEST(energy_in_play(scene, 100) == 1000 * 1000, kClose);
}

BOOST_AUTO_TEST_CASE(less_than_a_joule_is_as_much_as_it_is_and_none_at_all_counts_as_one) {
  Scene scene;
  scene.gravity.setZero();
  scene.bodies = {test::body("slow", 2, {1, 1, 1})};
  BOOST_TEST(energy_in_play(scene, 10) == 1);
  scene.bodies[0].velocity = {0.3, 0, 0};
  BOOST_TEST(energy_in_play(scene, 10) == 0.09, kClose);
}

BOOST_AUTO_TEST_CASE(springs_and_pushes_add_what_they_store_and_give) {
  Scene scene = ball_over(3, test::plane());
  scene.springs = {test::spring(kWorld, {0, 0, 4.5}, 0, {0, 0, 0}, 100, 0)};  // 1 m long
  BOOST_TEST(energy_in_play(scene, 10) == 8 + 50, kClose);                    // 40 N stretch it by 0.4 m
  scene.forces = {{.body = 0, .force = Vec3(0, 4, 0), .until = 1}};
  // The 8 J are 2.83 m/s, to which the push adds 2.
  BOOST_TEST(energy_in_play(scene, 10) == 50 + std::pow(std::sqrt(8) + 2, 2), kClose);
  scene.bodies[1].mass = 3;
  scene.forces.push_back({.body = 1, .force = Vec3(5, 0, 0), .until = 1});  // what is fixed gains nothing
  BOOST_TEST(energy_in_play(scene, 10) == 50 + std::pow(std::sqrt(8) + 2, 2), kClose);
}

BOOST_AUTO_TEST_SUITE_END()
