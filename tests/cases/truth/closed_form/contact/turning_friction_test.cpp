// Rolling and torsional friction in the truth `rolling`: the work of the couple, the stop, and what it is not for.
#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;
using test::truth_at;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_contact_turning_friction)

namespace {

const Sphere kBall{0.5};
constexpr double kG = 9.81;

BodyState state_of(const Scene& scene, double t) {
  return truth_at(*make_truth("rolling", scene, 60), t, scene.bodies.size()).columns().body(0);
}

Scene rolling_on_slope(double angle, double speed, double length) {
  Scene scene = test::on_slope(kBall, angle, 0.5, speed, speed / kBall.radius);
  scene.contact_default.rolling_friction = length;
  return scene;
}

double kinetic_energy(const Body& body, const BodyState& state) {
  return 0.5 * body.mass * state.velocity.squaredNorm() +
         0.5 * state.angular_velocity.dot(body.inertia * state.angular_velocity);
}

}  // namespace

// A second derivation: the energy falls by the couple times the angle, and rises by gravity's work.
BOOST_AUTO_TEST_CASE(the_energy_falls_by_the_work_of_the_couple) {
  for (const double angle : {0.0, 0.01, -0.01}) {
    const double length = 0.02;
    const Scene scene = rolling_on_slope(angle, 2, length);
    const Body& body = scene.bodies[0];
    for (const double t : {0.5, 2.0, 4.0}) {
      const BodyState now = state_of(scene, t);
      const Vec3 way = now.position - body.position;
      const double couple = length * body.mass * kG * std::cos(angle), turned = way.norm() / kBall.radius;
      const double expected =
          kinetic_energy(body, state_of(scene, 0)) + body.mass * scene.gravity.dot(way) - couple * turned;
      BOOST_TEST(std::abs(kinetic_energy(body, now) - expected) < 1e-12 * body.mass * kG);
      const Vec3 normal = test::slope_frame(angle).col(2);
      const Vec3 slip = now.velocity - kBall.radius * now.angular_velocity.cross(normal);
      BOOST_TEST(slip.norm() < 1e-14);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_ball_stops_where_the_couple_has_used_its_energy) {
  const double length = 0.02, speed = 2;
  const Scene scene = rolling_on_slope(0, speed, length);
  const double brake = kG * length / (kBall.radius * 1.4);
  BOOST_TEST(state_of(scene, speed / brake - 1e-6).velocity.x() > 0);
  BOOST_TEST(state_of(scene, speed / brake + 1e-9).velocity.norm() == 0);
  BOOST_TEST(state_of(scene, speed / brake + 1e-9).angular_velocity.norm() == 0);
  BOOST_TEST(state_of(scene, 50).position.x() == speed * speed / (2 * brake), boost::test_tools::tolerance(1e-14));
}

// Uphill it stops, and it rolls back only if the slope is steeper than d/r.
BOOST_AUTO_TEST_CASE(a_ball_comes_back_on_a_steep_slope_only) {
  BOOST_TEST(state_of(rolling_on_slope(0.03, -1, 0.02), 50).velocity.norm() == 0);
  const double angle = 0.08, back = kG * (std::sin(angle) - 0.04 * std::cos(angle)) / 1.4,
               up = kG * (std::sin(angle) + 0.04 * std::cos(angle)) / 1.4, turns = 1 / up;
  const BodyState later = state_of(rolling_on_slope(angle, -1, 0.02), turns + 3);
  BOOST_TEST((test::slope_frame(angle).transpose() * later.velocity).x() == 3 * back,
             boost::test_tools::tolerance(1e-13));
}

BOOST_AUTO_TEST_CASE(a_spin_ends_after_its_momentum_over_the_couple) {
  Scene scene = test::on_slope(kBall, 0, 0.5, 0);
  scene.bodies[0].angular_velocity = {0, 0, -8};
  scene.contact_default.torsional_friction = 0.02;
  const Body& body = scene.bodies[0];
  const double couple = 0.02 * body.mass * kG, end = 8 * body.inertia(2, 2) / couple;
  BOOST_TEST(state_of(scene, end / 2).angular_velocity.z() == -4, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(state_of(scene, end + 1).angular_velocity.norm() == 0);
  BOOST_TEST(state_of(scene, end + 1).velocity.norm() == 0);
}

BOOST_AUTO_TEST_CASE(it_says_what_it_is_not_for) {
  Scene slips = rolling_on_slope(0, 2, 0.02);
  slips.bodies[0].angular_velocity.setZero();
  BOOST_CHECK_THROW(make_truth("rolling", slips, 1), InputError);
  Scene spins = rolling_on_slope(0, 2, 0.02);
  spins.contact_default.torsional_friction = 0.01;
  spins.bodies[0].angular_velocity.z() = 1;
  BOOST_CHECK_THROW(make_truth("rolling", spins, 1), InputError);
  Scene slides = rolling_on_slope(0, 2, 0.02);
  slides.contact_default.friction = 0.001;  // less than the brake needs
  BOOST_CHECK_THROW(make_truth("rolling", slides, 1), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
