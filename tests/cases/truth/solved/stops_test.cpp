// The reference where limits, motors of a given speed and whole turns of a hinge act, against what quarter periods,
// parabolas and sines say.
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "cases/truth/truth.h"
#include "tests/cases/judged.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_stops)

namespace {

constexpr double kHalfTurn = std::numbers::pi;

// A body of 1 kg m² about z on a hinge there, turning at `speed`, or on a slider along x.
Scene on_axis(double speed, bool slides) {
  Scene scene;
  scene.gravity.setZero();
  scene.bodies = {test::body("arm", 1, {1, 1, 1}, {0, 0, 0})};
  scene.joints.push_back({kWorld, 0, HingeJoint{Vec3::Zero(), Vec3::UnitZ()}});
  if (slides) scene.joints[0].type = SliderJoint{Vec3::UnitX()};
  (slides ? scene.bodies[0].velocity.x() : scene.bodies[0].angular_velocity.z()) = speed;
  return scene;
}

struct State {
  double turn;  // rad, about z, from -pi to pi
  double x, speed, spin;
};
State at(const Truth& truth, double t) {
  const BodyState body = test::truth_at(truth, t, 1).columns().body(0);
  return {2 * std::atan2(body.orientation.z(), body.orientation.w()), body.position.x(), body.velocity.x(),
          body.angular_velocity.z()};
}
// Between two angles, whole turns apart or not.
double apart(double a, double b) { return std::abs(std::remainder(a - b, 2 * kHalfTurn)); }

}  // namespace

// It falls from the horizontal to the stop at the bottom, and bounces to where sin(x/2) is e times as large, each time.
BOOST_AUTO_TEST_CASE(a_pendulum_at_a_stop_rises_to_what_each_impact_leaves) {
  const Scene scene = test::suite_scene("joints/pendulum-at-stop");
  const auto truth = make_truth("reference", scene, 5);
  BOOST_TEST(truth->error(5) < 1e-12);
  const double w0 = std::sqrt(14.705808869457);  // published, 1/s
  double k = std::sin(kHalfTurn / 4), time = boost::math::ellint_1(k) / w0;
  for (int bounce = 1; bounce <= 4; ++bounce) {
    k *= scene.joints[0].restitution;
    const double quarter = boost::math::ellint_1(k) / w0;
    const BodyState top = test::truth_at(*truth, time + quarter, 1).columns().body(0);
    const double angle = 2 * std::asin(k);  // from the bottom
    BOOST_TEST((top.position - Vec3(0.5 * std::sin(angle), -0.5 * std::cos(angle), 0)).norm() < 2e-12);
    BOOST_TEST(top.angular_velocity.norm() < 1e-10);
    time += 2 * quarter;
  }
}

// The scene's head says how: 3 rad/s after 0.75 s, the limit at 4 rad, parabolas of half the speed, and rest.
BOOST_AUTO_TEST_CASE(a_motor_comes_to_its_speed_bounces_off_a_limit_and_presses_against_it) {
  const auto truth = make_truth("reference", test::suite_scene("joints/motor-to-limit"), 5);
  BOOST_TEST(truth->error(5) < 1e-11);
  const double hit = 0.75 + (4 - 1.125) / 3;
  const struct {
    double time, angle, spin;
  } rows[] = {{0.5, 0.5, 2},
              {1.2, 1.125 + 3 * 0.45, 3},
              {hit + 0.375, 4 - 0.28125, 0},
              {hit + 0.75 + 0.1875, 4 - 0.0703125, 0},
              {hit + 1.6, 4, 0},
              {5, 4, 0}};
  for (const auto& row : rows) {
    const State found = at(*truth, row.time);
    BOOST_TEST_CONTEXT("at " << row.time << " s") {
      BOOST_TEST(apart(found.turn, row.angle) < 1e-11);
      BOOST_TEST(std::abs(found.spin - row.spin) < 1e-10);
    }
  }
}

BOOST_AUTO_TEST_CASE(between_two_elastic_limits_a_slider_goes_to_and_fro) {
  Scene scene = on_axis(1, true);
  scene.joints[0].lower = -0.5, scene.joints[0].upper = 0.25, scene.joints[0].restitution = 1;
  const auto truth = make_truth("reference", scene, 10);
  for (const double t : {0.2, 0.9, 1.3, 9.7}) {
    const double way = std::fmod(t + 0.5, 1.5);  // from the lower one
    BOOST_TEST(std::abs(at(*truth, t).x - (way < 0.75 ? way - 0.5 : 1 - way)) < 1e-12);
  }
}

// Nothing pushes it, however slowly it comes.
BOOST_AUTO_TEST_CASE(what_creeps_to_a_limit_bounces_too) {
  Scene scene = on_axis(1e-7, true);
  scene.joints[0].upper = 1e-7, scene.joints[0].restitution = 0.5;
  const auto truth = make_truth("reference", scene, 3);
  BOOST_TEST(std::abs(at(*truth, 3).x - 0) < 1e-13);
  BOOST_TEST(std::abs(at(*truth, 3).speed + 0.5e-7) < 1e-14);
}

// I x'' = -k x: the spring winds on to 10 rad. Its angle jumps at half a turn, unless limits count whole turns.
BOOST_AUTO_TEST_CASE(the_truth_ends_where_the_angle_of_a_spring_jumps) {
  Scene scene = on_axis(20, false);
  scene.joints[0].stiffness = 4;
  const double jump = std::asin(std::numbers::pi / 10) / 2;  // s
  const auto truth = make_truth("reference", scene, 5);
  const double known = horizon(*truth, 1e-11, 5);
  BOOST_TEST(known <= jump);
  BOOST_TEST(known > 0.8 * jump);
  BOOST_TEST(apart(at(*truth, known).turn, 10 * std::sin(2 * known)) < 1e-11);
  BOOST_TEST(std::isinf(truth->error(jump)));
  BOOST_TEST(truth->caveat().find("jumps") != std::string::npos);

  scene.joints[0].lower = -0.1, scene.joints[0].upper = 6;
  scene.bodies[0].angular_velocity *= 0.5;  // 5 rad
  const auto counted = make_truth("reference", scene, 1.5);
  BOOST_TEST(counted->caveat() == "");
  BOOST_TEST(counted->error(1.5) < 1e-11);
  for (const double t : {0.3, 0.8, 1.5}) BOOST_TEST(apart(at(*counted, t).turn, 5 * std::sin(2 * t)) < 1e-11);
}

// Down with gravity, which is more than it holds back near the horizontal, and up the other side until it cannot.
BOOST_AUTO_TEST_CASE(a_motor_keeps_its_speed_as_long_as_it_is_strong_enough) {
  Scene scene = test::suite_scene("joints/pendulum-90");
  scene.motors.push_back({.joint = 0, .speed = -1.0, .most = 4});
  const auto truth = make_truth("reference", scene, 6);
  BOOST_TEST(truth->error(6) < 1e-10);
  int kept = 0, lost = 0;
  for (double t = 0; t < 6; t += 0.02) {
    const double off = std::abs(at(*truth, t).spin + 1);
    if (off < 1e-12) ++kept;
    if (off > 0.1 && kept > 0) ++lost;
  }
  BOOST_TEST(kept > 10);
  BOOST_TEST(lost > 10);
}

// Falling freely nothing presses on anything: what stands at its limits stays there, and no rounding decides otherwise.
BOOST_AUTO_TEST_CASE(a_mechanism_that_falls_freely_stays_at_its_limits) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {test::body("trunk", 4.7, {.02, .06, .06}, {.013, .002, 0}),
                  test::body("thigh", 1.01, {.005, .006, .001}, {.18, -.11, -.03}),
                  test::body("calf", .226, {.003, .003, 3e-5}, {.27, -.13, -.26})};
  scene.joints.push_back({0, 1, HingeJoint{Vec3(.18, -.05, 0), Vec3::UnitX()}});
  scene.joints.push_back({1, 2, HingeJoint{Vec3(.18, -.13, -.2), Vec3::UnitY()}});
  scene.joints[0].upper = 0, scene.joints[1].upper = 0, scene.joints[1].lower = -1.8;
  const auto truth = make_truth("reference", scene, 2);
  BOOST_TEST(truth->error(2) < 1e-12);
  const BodyTable end = test::truth_at(*truth, 2, 3);
  for (int i = 0; i < 3; ++i) {
    const Vec3 fallen = scene.bodies[i].position + Vec3(0, 0, -.5 * 9.81 * 4);
    BOOST_TEST((end.columns().position(i) - fallen).norm() < 1e-12);
  }
}

BOOST_AUTO_TEST_SUITE_END()
