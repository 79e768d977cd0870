#include <boost/test/unit_test.hpp>
#include <numbers>

#include "core/base/error.h"
#include "tests/cases/judged.h"

using namespace rigor;
using test::truth_at;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_smooth_projectile)

BOOST_AUTO_TEST_CASE(the_thrown_cube_follows_the_parabola_and_turns_about_the_vertical) {
  const Scene scene = test::thrown_cube();
  const auto truth = make_truth("projectile", scene, 10);
  for (const double t : {0.0, 0.5, 1.0, 10.0}) {
    const BodyTable now = truth_at(*truth, t, 1);
    const BodyState cube = now.columns().body(0);
    // A few roundings of numbers up to 490 (the fall after 10 s) and of an angle of 100 rad.
    BOOST_TEST((cube.position - Vec3(-2.45 + 4.9 * t, 0.5 + 4.9 * t - 4.9 * t * t, 0)).norm() < 1e-12);
    BOOST_TEST((cube.velocity - Vec3(4.9, 4.9 - 9.8 * t, 0)).norm() < 1e-12);
    const Quat turned = Quat(Eigen::AngleAxisd(10 * t, Vec3::UnitY())) * scene.bodies[0].orientation;
    BOOST_TEST(angle_between(cube.orientation, turned) < 1e-12);
    BOOST_TEST(truth->error(t) < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(it_agrees_with_the_reference) {
  Scene scene = test::thrown_cube();
  Body spun = test::body("spun", 3, {1, 2, 3}, {5, 5, 5});
  spun.orientation = Quat(0.1, 0.2, 0.3, 0.4).normalized();
  spun.angular_velocity = matrix_of(spun.orientation) * Vec3(0, 0, 4);
  scene.bodies.push_back(spun);
  const auto closed = make_truth("projectile", scene, 5), solved = make_truth("reference", scene, 5);
  for (const double t : {0.3, 2.0, 5.0}) {
    const BodyTable a = truth_at(*closed, t, 2), b = truth_at(*solved, t, 2);
    for (std::size_t i = 0; i < 2; ++i) {
      // Both say they are good to about 1e-13 m and rad here.
      BOOST_TEST((a.columns().position(i) - b.columns().position(i)).norm() <= closed->error(t) + solved->error(t));
      BOOST_TEST(angle_between(a.columns().orientation(i), b.columns().orientation(i)) <=
                 closed->error(t) + solved->error(t));
    }
    BOOST_TEST(closed->error(t) + solved->error(t) < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(a_scene_it_does_not_hold_for_is_refused_with_the_reason) {
  BOOST_CHECK_EXCEPTION(make_truth("projectile", test::fixed_spring(), 1), InputError, test::says("spring"));
  BOOST_CHECK_EXCEPTION(make_truth("projectile", test::dropped_sphere(1), 1), InputError, test::says("may touch"));
  BOOST_CHECK_EXCEPTION(make_truth("projectile", test::tumbling_body(), 1), InputError,
                        test::says("'top' would tumble"));
}

BOOST_AUTO_TEST_SUITE_END()
