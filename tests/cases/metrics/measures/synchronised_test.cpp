// Velocities brought to the positions' time, on motions of which the velocity at each instant is known.
#include "cases/metrics/measures/synchronised.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_synchronised)

namespace {

constexpr double kDt = 0.02;  // s

Scene bead(bool can_touch) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("bead", Sphere{0.5}, 2, {0, 0, 5})};
  if (can_touch) scene.bodies.push_back(test::plane());
  return scene;
}

// A body on its path, and the velocity as a method stores it.
using Motion = std::function<BodyState(int step)>;
Trajectory run_of(const Scene& scene, const Motion& motion, int steps) {
  Trajectory run{kDt, {}};
  for (int n = 0; n <= steps; ++n) {
    BodyTable table(scene.bodies.size());
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      table.columns().set_body(i, {Vec3::Zero(), Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
    table.columns().set_body(0, motion(n));
    run.samples.push_back({n * kDt, table});
  }
  return run;
}

// The first body's velocity at each sample, once brought forward.
std::vector<BodyState> synchronised(const Scene& scene, const Trajectory& run, double stagger) {
  std::vector<BodyState> found;
  const Synchroniser synchroniser(scene, run, stagger);
  for (std::size_t n = 0; n < run.samples.size(); ++n) {
    BodyTable bodies(run.samples[n].bodies.columns());
    synchroniser.apply(n, bodies.columns());
    found.push_back(std::as_const(bodies).columns().body(0));
  }
  return found;
}

BodyState along(double place, double speed) { return {{place, 0, 0}, Quat::Identity(), {speed, 0, 0}, Vec3::Zero()}; }

// One step of semi-implicit Euler after another under acceleration(place, speed) [m/s²].
template <typename Acceleration>
Motion semi_implicit(double place, double speed, const Acceleration& acceleration) {
  return [=](int steps) {
    double x = place, v = speed;
    for (int n = 0; n < steps; ++n) v += kDt * acceleration(x, v), x += kDt * v;
    return along(x, v);
  };
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_lags_by_half_a_step_gains_what_acts_in_it) {
  const Scene scene = bead(false);
  const auto found = synchronised(scene, run_of(scene, semi_implicit(0, 3, [](auto, auto) { return -10.; }), 50), 0.5);
  for (std::size_t n = 0; n < found.size(); ++n)  // of the parabola that starts half a step early
    BOOST_TEST(std::abs(found[n].velocity.x() - (3 - 10 * (n + 0.5) * kDt)) < 1e-13);
}

BOOST_AUTO_TEST_CASE(a_spin_that_lags_gains_what_acts_in_half_a_step_and_a_fixed_body_nothing) {
  Scene scene = bead(false);
  scene.bodies.push_back(scene.bodies[0]), scene.bodies[1].fixed = true;
  const Motion spun_up = [](int n) {
    const double spin = 4 * n * kDt, angle = 0.5 * 4 * n * (n + 1) * kDt * kDt;
    return BodyState{Vec3::Zero(), rotation_by({angle, 0, 0}), Vec3::Zero(), {spin, 0, 0}};
  };
  Trajectory run = run_of(scene, spun_up, 50);
  for (std::size_t n = 0; n < run.samples.size(); ++n)
    run.samples[n].bodies.columns().set_velocity(1, {static_cast<double>(n), 0, 0});
  const Synchroniser synchroniser(scene, run, 0.5);
  for (std::size_t n = 0; n < run.samples.size(); ++n) {
    BodyTable bodies(run.samples[n].bodies.columns());
    synchroniser.apply(n, bodies.columns());
    BOOST_TEST(std::abs(bodies.columns().angular_velocity(0).x() - 4 * (n + 0.5) * kDt) < 1e-12);
    BOOST_TEST(bodies.columns().velocity(1).x() == n);
  }
}

BOOST_AUTO_TEST_CASE(nothing_is_brought_forward_without_a_lag) {
  const Scene scene = bead(false);
  const Trajectory run = run_of(scene, semi_implicit(0, 3, [](auto, auto) { return -10.; }), 5);
  for (std::size_t n = 0; n < 6; ++n)
    BOOST_TEST(synchronised(scene, run, 0)[n].velocity == run.samples[n].bodies.columns().velocity(0));
}

// Held in contact by forces at each stage, say: x = 3 t - 5 t², with the velocity of that instant.
BOOST_AUTO_TEST_CASE(velocities_of_the_positions_own_time_stay_as_they_are) {
  for (const bool can_touch : {false, true}) {
    const Scene scene = bead(can_touch);
    const Trajectory run = run_of(
        scene,
        [](int n) {
          const double t = n * kDt, angle = t * t;
          return BodyState{{3 * t - 5 * t * t, 0, 0}, rotation_by({angle, 0, 0}), {3 - 10 * t, 0, 0}, {2 * t, 0, 0}};
        },
        50);
    const auto found = synchronised(scene, run, 0.5);
    for (std::size_t n = 0; n < found.size(); ++n) {
      BOOST_TEST(std::abs(found[n].velocity.x() - (3 - 10 * n * kDt)) < 1e-12);
      BOOST_TEST(std::abs(found[n].angular_velocity.x() - 2 * n * kDt) < 1e-10);
    }
  }
}

// 32 semi-implicit sub-steps in a step: the velocity lags by half of one of them.
BOOST_AUTO_TEST_CASE(of_a_step_in_many_the_velocity_lags_by_half_of_one) {
  const Scene scene = bead(true);
  const int parts = 32;
  const double part = kDt / parts;
  const Motion divided = [=](int n) {
    const double k = n * parts;
    return along(3 * k * part - 5 * k * (k + 1) * part * part, 3 - 10 * k * part);
  };
  const auto found = synchronised(scene, run_of(scene, divided, 50), 0.5);
  for (std::size_t n = 0; n < found.size(); ++n)
    BOOST_TEST(std::abs(found[n].velocity.x() - (3 - 10 * (n * kDt + 0.5 * part))) < 1e-12);
}

BOOST_AUTO_TEST_CASE(what_rests_gains_nothing) {
  const Scene scene = bead(true);
  const auto found = synchronised(scene,
                                  run_of(
                                      scene, [](int) { return along(0.5, 0); }, 10),
                                  0.5);
  for (const BodyState& state : found) BOOST_TEST(state.velocity.isZero(0));
}

// An implicit damper of c h/m = 5: each step divides the speed by 6. The free acceleration would turn it round.
BOOST_AUTO_TEST_CASE(a_stiff_damper_turns_no_velocity_round) {
  const Scene scene = bead(false);
  const Motion braked = [](int n) {
    double x = 0, v = 3;
    for (int k = 0; k < n; ++k) v /= 6, x += kDt * v;
    return along(x, v);
  };
  const Trajectory run = run_of(scene, braked, 20);
  const auto found = synchronised(scene, run, 0.5);
  for (std::size_t n = 0; n + 1 < found.size(); ++n) {
    BOOST_TEST(found[n].velocity.x() > 0);
    BOOST_TEST(found[n].velocity.x() <= run.samples[n].bodies.columns().velocity(0).x());
  }
}

// Down at 10 m/s² and up again with half the speed at step 20, by semi-implicit Euler.
BOOST_AUTO_TEST_CASE(an_impact_is_no_acceleration) {
  const Scene scene = bead(true);
  const double hit = 20;
  const Motion bouncing = [=](int n) {
    double x = 0, v = 0;
    for (int k = 1; k <= n; ++k) v = k == hit ? -0.5 * v : v - 10 * kDt, x += kDt * v;
    return along(x, v);
  };
  const Trajectory run = run_of(scene, bouncing, 40);
  const auto found = synchronised(scene, run, 0.5);
  for (std::size_t n = 0; n < found.size(); ++n) {
    const double read = run.samples[n].bodies.columns().velocity(0).x();
    BOOST_TEST(std::abs(found[n].velocity.x() - (read - 5 * kDt)) < 1e-12);
  }
}

// A pendulum of 1 m in its angle, as engines in joint coordinates step it: w1 = w0 - h g cos(angle), angle1 = angle0 +
// h w1. The largest error of its energy [J], as read and synchronised.
std::pair<double, double> errors_of_pendulum(double dt) {
  Scene scene;
  scene.gravity = {0, -10, 0};
  scene.bodies = {test::body("bob", 1, {1e-9, 1e-9, 1e-9}, {1, 0, 0})};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}}};
  double angle = 0, w = 0;
  Trajectory run{dt, {}};
  std::vector<double> angles;
  for (int n = 0; n * dt <= 4; ++n) {
    if (n > 0) w += dt * -10 * std::cos(angle), angle += dt * w;
    BodyTable table(1);
    const Vec3 out(std::cos(angle), std::sin(angle), 0), ahead(-out.y(), out.x(), 0);
    table.columns().set_body(0, {out, rotation_by({0, 0, angle}), w * ahead, {0, 0, w}});
    run.samples.push_back({n * dt, table}), angles.push_back(angle);
  }
  const auto found = synchronised(scene, run, 0.5);
  std::pair<double, double> most;
  for (std::size_t n = 0; n < found.size(); ++n) {
    const double height = 10 * std::sin(angles[n]), raw = run.samples[n].bodies.columns().velocity(0).norm();
    BOOST_TEST(std::abs(found[n].velocity.dot(found[n].position)) < 1e-12);  // along its circle
    most.first = std::max(most.first, std::abs(0.5 * raw * raw + height));
    most.second = std::max(most.second, std::abs(0.5 * found[n].velocity.squaredNorm() + height));
  }
  return most;
}

// As read the error is of first order, half at half the step; synchronised, of second order, a fourth.
BOOST_AUTO_TEST_CASE(the_speed_of_a_jointed_body_is_brought_forward_and_its_direction_stays) {
  const auto coarse = errors_of_pendulum(0.02), fine = errors_of_pendulum(0.01);
  BOOST_TEST(coarse.first / fine.first < 2.2);
  BOOST_TEST(coarse.second / fine.second > 3.5);
  BOOST_TEST(coarse.second < 0.2 * coarse.first);
}

// Impacts in every step turn the velocity by turns, as where a box rests on one edge after another. The velocity at the
// positions' time is then not determined. The bounds hold the velocity as stored and those brought forward.
BOOST_AUTO_TEST_CASE(between_two_impacts_the_velocity_has_bounds) {
  const Scene scene = bead(true);
  const Motion rattling = [](int n) {
    double x = 0, v = 2;
    for (int k = 1; k <= n; ++k) v = k % 2 == 1 ? 1.9 : 2, x += kDt * v;
    return along(x, v);
  };
  const Trajectory run = run_of(scene, rattling, 20);
  const Synchroniser synchroniser(scene, run, 0.5);
  for (std::size_t n = 1; n < 20; ++n) {
    BodyTable least(run.samples[n].bodies.columns()), most = least;
    synchroniser.apply_bounds(n, least.columns(), most.columns());
    const double read = run.samples[n].bodies.columns().velocity(0).x();
    const double low = least.columns().velocity(0).norm(), high = most.columns().velocity(0).norm();
    BOOST_TEST(low == std::min(read, 1.95), boost::test_tools::tolerance(1e-12));
    BOOST_TEST(high >= std::max(read, 1.95) - 1e-12);
    BOOST_TEST(high < 2 + 0.01);  // gravity is across: (0.1 m/s)²/2 of 2 m/s more
  }
}

BOOST_AUTO_TEST_CASE(in_flight_and_in_smooth_contact_the_bounds_agree) {
  const Scene scene = bead(true);
  for (const double acceleration : {-10., -3., 7.}) {
    const Trajectory run = run_of(scene, semi_implicit(0, 3, [=](auto, auto) { return acceleration; }), 20);
    const Synchroniser synchroniser(scene, run, 0.5);
    for (std::size_t n = 0; n <= 20; ++n) {
      BodyTable least(run.samples[n].bodies.columns()), most = least;
      synchroniser.apply_bounds(n, least.columns(), most.columns());
      BOOST_TEST(std::abs(least.columns().velocity(0).x() - (3 + acceleration * (n + 0.5) * kDt)) < 1e-12);
      BOOST_TEST((least.columns().velocity(0) == most.columns().velocity(0)));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
