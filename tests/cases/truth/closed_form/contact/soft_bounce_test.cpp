// The truth `soft-bounce` against the formula of a bounce without gravity, an energy balance, and the law integrated in
// small steps.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/base/error.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;
using test::truth_at;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_contact_soft_bounce)

namespace {

constexpr double kStiffness = 1e4;

Scene falling_ball(double height, double damping, double gravity = 9.81) {
  Scene scene;
  scene.gravity = {0, 0, -gravity};
  scene.bodies = {test::on_its_own("ball", Sphere{0.1}, 1, {0, 0, 0.1 + height}), test::plane()};
  scene.contact_default = {.stiffness = kStiffness, .damping = damping};
  return scene;
}

BodyState state_of(const Scene& scene, double t) {
  return truth_at(*make_truth("soft-bounce", scene, 5), t, scene.bodies.size()).columns().body(0);
}

// The law by the classical Runge–Kutta method in steps of 2 µs: its error at the jump of the force is below 1e-5 m.
std::pair<double, double> marched(double height, double speed, const ContactLaw& law, double gravity, double until) {
  const auto slope = [&](double z, double v) {
    const double elastic = -kStiffness * z;
    const double force = z < 0 ? std::max(0.0, elastic * (1 - law.dissipation * v) - law.damping * v) : 0;
    return std::pair(v, force - gravity);
  };
  const int steps = static_cast<int>(std::lround(until / 2e-6));
  const double h = until / steps;
  double z = height, v = speed;
  for (int i = 0; i < steps; ++i) {
    const auto [z1, v1] = slope(z, v);
    const auto [z2, v2] = slope(z + h / 2 * z1, v + h / 2 * v1);
    const auto [z3, v3] = slope(z + h / 2 * z2, v + h / 2 * v2);
    const auto [z4, v4] = slope(z + h * z3, v + h * v3);
    z += h / 6 * (z1 + 2 * z2 + 2 * z3 + z4), v += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
  }
  return {z, v};
}

}  // namespace

// As gravity vanishes: 1e-6 m/s² changes the speed by as much in the time of flight and contact, below 1 s.
BOOST_AUTO_TEST_CASE(the_speed_after_is_that_of_the_formula_without_gravity) {
  for (const double damping : {0.0, 10.0, 60.0, 150.0}) {
    Scene scene = falling_ball(0.1, damping, 1e-6);
    scene.bodies[0].velocity.z() = -2;
    const double z = damping / (2 * std::sqrt(kStiffness)), e = std::exp(-2 * z * std::acos(z) / std::sqrt(1 - z * z));
    BOOST_TEST(std::abs(state_of(scene, 0.2).velocity.z() - 2 * e) < 1e-6, damping);
  }
}

BOOST_AUTO_TEST_CASE(without_a_damper_the_energy_stays) {
  const Scene scene = falling_ball(0.5, 0);
  for (int i = 0; i <= 500; ++i) {
    const BodyState now = state_of(scene, 0.01 * i);
    const double z = now.position.z() - 0.1;
    const double energy = 0.5 * now.velocity.squaredNorm() + 9.81 * z + (z < 0 ? 0.5 * kStiffness * z * z : 0);
    BOOST_TEST(std::abs(energy - 9.81 * 0.5) < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(it_is_the_law_step_by_step) {
  for (const double damping : {0.0, 40.0, 100.0, 190.0, 200.0, 400.0}) {
    for (const double t : {0.33, 0.9, 1.5, 3.0}) {
      const auto [z, v] = marched(0.5, 0, {.damping = damping}, 9.81, t);
      const BodyState found = state_of(falling_ball(0.5, damping), t);
      BOOST_TEST_CONTEXT("damping " << damping << " t " << t) {
        BOOST_TEST(std::abs(found.position.z() - 0.1 - z) < 2e-4);
        BOOST_TEST(std::abs(found.velocity.z() - v) < 5e-3);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_ball_at_rest_sags_by_its_weight_over_the_stiffness) {
  const Scene scene = falling_ball(-9.81 / kStiffness, 20);
  BOOST_TEST(std::abs(state_of(scene, 3).position.z() - (0.1 - 9.81 / kStiffness)) < 1e-15);
  BOOST_TEST(state_of(scene, 3).velocity.norm() < 1e-15);
}

BOOST_AUTO_TEST_CASE(it_says_what_it_is_not_for) {
  Scene sideways = falling_ball(0.5, 0);
  sideways.bodies[0].velocity.x() = 1;
  BOOST_CHECK_THROW(make_truth("soft-bounce", sideways, 1), InputError);
  Scene rigid = falling_ball(0.5, 0);
  rigid.contact_default = {};
  BOOST_CHECK_THROW(make_truth("soft-bounce", rigid, 1), InputError);
  Scene rough = falling_ball(0.5, 0);
  rough.contact_default.friction = 0.5;
  BOOST_CHECK_THROW(make_truth("soft-bounce", rough, 1), InputError);
  BOOST_CHECK_THROW(make_truth("bounce", falling_ball(0.5, 0), 1), InputError);
}

// Without gravity m v dv/(1 + d v) = -k x dx, so d v - ln(1 + d v) is the same before and after.
BOOST_AUTO_TEST_CASE(hunt_and_crossleys_speed_after_is_that_of_the_integral_without_gravity) {
  for (const double dissipation : {0.05, 0.2, 1.0}) {
    Scene scene = falling_ball(0.1, 0, 1e-9);
    scene.contact_default.dissipation = dissipation;
    scene.bodies[0].velocity.z() = -2;
    const double after = state_of(scene, 0.4).velocity.z();
    const auto kept = [&](double v) { return dissipation * v - std::log1p(dissipation * v); };
    BOOST_TEST(after > 0.5);
    BOOST_TEST(after < 2 / (1 + 0.5 * dissipation));
    BOOST_TEST(std::abs(kept(-after) - kept(2)) < 1e-8, dissipation);  // gravity acts for below 1 s
  }
}

// The force has a kink where the contact begins, which costs the march 1e-7 m/s a bounce.
BOOST_AUTO_TEST_CASE(hunt_and_crossleys_law_is_that_step_by_step) {
  for (const double dissipation : {0.05, 0.5}) {
    Scene scene = falling_ball(0.5, 0);
    scene.contact_default.dissipation = dissipation;
    for (const double t : {0.33, 0.9, 1.5, 3.0}) {
      const auto [z, v] = marched(0.5, 0, {.dissipation = dissipation}, 9.81, t);
      const BodyState found = state_of(scene, t);
      BOOST_TEST_CONTEXT("dissipation " << dissipation << " t " << t) {
        BOOST_TEST(std::abs(found.position.z() - 0.1 - z) < 1e-5);
        BOOST_TEST(std::abs(found.velocity.z() - v) < 1e-3);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(hunt_and_crossleys_ball_must_start_above_the_plane) {
  Scene scene = falling_ball(-0.01, 0);
  scene.contact_default.dissipation = 0.2;
  BOOST_CHECK_EXCEPTION(make_truth("soft-bounce", scene, 1), InputError, test::says("starts inside the plane"));
}

BOOST_AUTO_TEST_SUITE_END()
