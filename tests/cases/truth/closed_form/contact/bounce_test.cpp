#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "core/dynamics/model/energy.h"
#include "tests/cases/judged.h"

using namespace rigor;
using test::truth_at;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_contact_bounce)

namespace {

double height_at(const Truth& truth, double t) { return truth_at(truth, t, 2).columns().position(0).y() - 0.1; }

// A second derivation: parabola after parabola, each impact found from the last, until the flights are too short to
// see.
struct Marched {
  double height, speed;
};
Marched march(double height, double g, double e, double t) {
  double speed = 0;
  for (int bounce = 0; bounce < 10000; ++bounce) {
    const double impact = (speed + std::sqrt(speed * speed + 2 * g * height)) / g;
    if (t < impact) return {height + speed * t - 0.5 * g * t * t, speed - g * t};
    t -= impact;
    speed = e * (g * impact - speed);
    height = 0;
    if (speed < 1e-13) break;
  }
  return {0, 0};
}

Scene ball_over_ground(double height, double restitution, double friction = kInfiniteFriction) {
  Scene scene = test::dropped_sphere(restitution);
  scene.gravity = {0, -9.81, 0};
  scene.bodies[0].position.y() = height + 0.1;
  scene.contact_default.friction = friction;
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_agrees_with_marching_from_impact_to_impact) {
  for (const double e : {0.0, 0.3, 0.5, 0.8, 0.95, 1.0}) {
    const auto truth = make_truth("bounce", ball_over_ground(1, e), 10);
    for (double t = 0; t < 10; t += 0.0137) {
      const Marched expected = march(1, 9.81, e, t);
      BOOST_TEST_CONTEXT("e = " << e << ", t = " << t)
      // Both sum tens of flights; where they are many and short an impact's rounding is a jump of a tiny speed.
      BOOST_TEST(std::abs(height_at(*truth, t) - expected.height) < 1e-12);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_ball_comes_to_rest_at_the_published_instant) {
  // h = 1, g = 9.81: apex .25 / .64 of it and at rest at 1.354571 / 4.063713 s, the digits as printed.
  struct Row {
    double e, apex, rest;
  };
  for (const Row& row : {Row{0.5, 0.25, 1.354571}, Row{0.8, 0.64, 4.063713}}) {
    const auto truth = make_truth("bounce", ball_over_ground(1, row.e), 10);
    const double fall = std::sqrt(2 / 9.81);
    BOOST_TEST(height_at(*truth, fall * (1 + row.e)) == row.apex, boost::test_tools::tolerance(1e-12));
    const double just_before = row.rest - 1e-5, just_after = row.rest + 1e-6;
    BOOST_TEST(truth_at(*truth, just_before, 2).columns().velocity(0).y() != 0);
    BOOST_TEST(truth_at(*truth, just_after, 2).columns().velocity(0).y() == 0);
    BOOST_TEST(height_at(*truth, just_after) == 0);
  }
}

BOOST_AUTO_TEST_CASE(a_ball_that_starts_on_the_ground_stays_there) {
  for (const double e : {0.0, 0.5, 1.0}) {
    const auto truth = make_truth("bounce", ball_over_ground(0, e), 10);
    BOOST_TEST(height_at(*truth, 3) == 0);
    BOOST_TEST(truth_at(*truth, 3, 2).columns().velocity(0).norm() == 0);
  }
}

BOOST_AUTO_TEST_CASE(a_throw_up_or_down_lands_when_it_must) {
  for (const double v : {-3.0, 3.0}) {
    Scene scene = ball_over_ground(2, 0);
    scene.bodies[0].velocity = {0, v, 0};
    const auto truth = make_truth("bounce", scene, 10);
    const double impact = (v + std::sqrt(v * v + 4 * 9.81)) / 9.81;
    BOOST_TEST(height_at(*truth, impact - 1e-6) > 0);
    BOOST_TEST(height_at(*truth, impact + 1e-12) == 0);
  }
}

BOOST_AUTO_TEST_CASE(the_elastic_ball_keeps_its_energy) {
  const Scene scene = ball_over_ground(1, 1);
  const auto truth = make_truth("bounce", scene, 30);
  const double start = energy(scene, truth_at(*truth, 0, 2).columns());
  for (double t = 0; t < 30; t += 0.01) {
    // Its phase after 33 flights is right to 1e-14 s, at 4.4 m/s and 100 kg.
    BOOST_TEST(std::abs(energy(scene, truth_at(*truth, t, 2).columns()) - start) < 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(infinite_friction_makes_a_sliding_ball_roll_from_its_first_impact) {
  Scene scene = ball_over_ground(1, 0.5);
  scene.bodies[0].velocity = {7, 0, 0};
  const auto truth = make_truth("bounce", scene, 10);
  const BodyTable after = truth_at(*truth, 2, 2);
  // A solid sphere that had no spin rolls on with 5/7 of its speed: L about the contact point is kept.
  BOOST_TEST(after.columns().velocity(0).x() == 5, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(after.columns().angular_velocity(0).z() == -50, boost::test_tools::tolerance(1e-13));
}

// A second derivation of Coulomb's law in impacts: each marched from the last, in components.
struct Rolled {
  double x = 0, v = 7, w = -3;  // m, m/s, and rad/s about z, such that v + 0.1 w is the slip
};
Rolled march_sideways(double height, double g, double e, double mu, double until) {
  Rolled now;
  double t = 0, speed = 0;
  bool rests = false;
  for (int n = 0; n < 10000 && !rests; ++n) {
    const double flight = (speed + std::sqrt(speed * speed + 2 * g * height)) / g;
    if (t + flight > until) break;
    t += flight, now.x += now.v * flight;
    const double impact = g * flight - speed, slip = now.v + 0.1 * now.w;
    // A solid sphere's point of contact has 2/7 of its mass.
    const double impulse = std::min(mu * (1 + e) * impact, std::abs(slip) * 2 / 7) * (slip > 0 ? 1 : -1);
    now.v -= impulse, now.w -= impulse * 0.1 / (0.4 * 0.1 * 0.1);
    speed = e * impact, height = 0;
    rests = speed < 1e-13;
  }
  const double slip = now.v + 0.1 * now.w, ends = std::abs(slip) * 2 / 7 / (mu * g);
  const double sign = slip > 0 ? 1 : -1, left = until - t, slides = rests ? std::min(left, ends) : 0;
  now.x += now.v * left - sign * mu * g * slides * (left - slides / 2);
  now.v -= sign * mu * g * slides, now.w -= sign * mu * g * slides * 25;
  return now;
}

BOOST_AUTO_TEST_CASE(coulomb_friction_brakes_the_slip_at_each_impact_and_after_them) {
  for (const double e : {0.0, 0.5, 0.8, 1.0}) {
    for (const double mu : {0.03, 0.1, 0.3}) {
      Scene scene = ball_over_ground(1, e, mu);
      scene.bodies[0].inertia = 0.4 * 100 * 0.01 * Mat3::Identity();
      scene.bodies[0].velocity = {7, 0, 0}, scene.bodies[0].angular_velocity = {0, 0, -3};
      const auto truth = make_truth("bounce", scene, 10);
      for (const double t : {0.2, 0.6, 1.3, 2.1, 4.4, 9.7}) {
        const Rolled expected = march_sideways(1, 9.81, e, mu, t);
        const BodyState found = truth_at(*truth, t, 2).columns().body(0);
        BOOST_TEST_CONTEXT("e = " << e << ", mu = " << mu << ", t = " << t) {
          BOOST_TEST(std::abs(found.position.x() - expected.x) < 1e-12);  // some hundred roundings of 70 m
          BOOST_TEST(std::abs(found.velocity.x() - expected.v) < 1e-13);
          BOOST_TEST(std::abs(found.angular_velocity.z() - expected.w) < 1e-12);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(backspin_can_throw_a_ball_back) {
  Scene scene = ball_over_ground(1, 0.5, kInfiniteFriction);
  scene.bodies[0].inertia = 0.4 * 100 * 0.01 * Mat3::Identity();
  scene.bodies[0].velocity = {1, 0, 0}, scene.bodies[0].angular_velocity = {0, 0, 100};
  const BodyTable after = truth_at(*make_truth("bounce", scene, 5), 1, 2);
  // L about the contact point: m r v - I w is kept and becomes (7/5) m r v'.
  BOOST_TEST(after.columns().velocity(0).x() == (1 - 0.4 * 0.1 * 100) * 5 / 7, boost::test_tools::tolerance(1e-13));
}

BOOST_AUTO_TEST_CASE(without_friction_a_ball_drifts_and_spins_as_it_started) {
  Scene scene = ball_over_ground(1, 0.5, 0);
  scene.bodies[0].velocity = {7, 0, 0};
  scene.bodies[0].angular_velocity = {0, 0, 3};
  const auto truth = make_truth("bounce", scene, 10);
  const BodyTable after = truth_at(*truth, 2, 2);
  BOOST_TEST(after.columns().position(0).x() == 14, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(angle_between(after.columns().orientation(0), Quat(Eigen::AngleAxisd(6, Vec3::UnitZ()))) < 1e-13);
}

BOOST_AUTO_TEST_CASE(a_scene_it_does_not_hold_for_is_refused_with_the_reason) {
  struct Row {
    void (*spoil)(Scene&);
    const char* says;
  };
  const Row rows[] = {
      {[](Scene& s) { s.gravity.setZero(); }, "no gravity"},
      {[](Scene& s) {
         s.gravity = {1, -9, 0};
       },
       "not opposite to gravity"},
      {[](Scene& s) { s.bodies[0].position.y() = 0.05; }, "inside the plane"},
      {[](Scene& s) {
         s.bodies[0].shape = Box{{1, 1, 1}};
       },
       "'ball' is not a sphere"},
      {[](Scene& s) { s.bodies[1].collides = false; }, "no plane"},
      {[](Scene& s) { s.bodies.push_back(s.bodies[1]); }, "second plane"},
      {[](Scene& s) { s.springs.emplace_back(); }, "springs"},
      {[](Scene& s) { s.bodies.push_back(s.bodies[0]); }, "could touch"},
      {[](Scene& s) {
         s.contact_default.friction = 0.05, s.bodies[0].velocity = {9, 0, 0}, s.bodies[0].angular_velocity = {0, 9, 0};
       },
       "spins about another axis"},
      {[](Scene& s) {
         s.bodies[0].inertia(2, 2) = 9, s.bodies[0].angular_velocity = {1, 0, 0};
       },
       "inertia"},
  };
  for (const Row& row : rows) {
    Scene scene = test::dropped_sphere(0.5);
    row.spoil(scene);
    BOOST_CHECK_EXCEPTION(make_truth("bounce", scene, 9), InputError, test::says(row.says));
  }
}

BOOST_AUTO_TEST_SUITE_END()
