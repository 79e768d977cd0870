// A ball on a spring that strikes a wall: against the oscillator where there is no wall, and against the laws of each
// blow.
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_contact_sprung_ball)

namespace {

constexpr double kFrequency = 2 * std::numbers::pi;  // rad/s: a free swing takes a second

// The spring rests where the ball's centre is at x = 0; the wall stops the centre at `wall`.
Scene swing(double start, double speed, double wall, double restitution) {
  Scene scene;
  Body ball = test::body("ball", 1, {1, 1, 1}, {start, 0, 0});
  ball.shape = Sphere{0.1}, ball.collides = true, ball.velocity = {speed, 0, 0};
  Body plane;
  plane.name = "wall", plane.shape = Plane{-Vec3::UnitX(), -(wall + 0.1)}, plane.fixed = plane.collides = true;
  scene.bodies = {ball, plane};
  scene.springs = {test::spring(kWorld, {-3, 0, 0}, 0, Vec3::Zero(), kFrequency * kFrequency, 3)};
  scene.contact_default = {restitution, 0};
  return scene;
}

BodyState at(const Truth& truth, double t) { return test::truth_at(truth, t, 2).columns().body(0); }

}  // namespace

BOOST_AUTO_TEST_CASE(where_it_does_not_reach_the_wall_it_is_the_oscillator) {
  Scene scene = swing(-0.3, 1, 0.5, 0.7);
  const auto struck = make_truth("sprung-ball", scene, 5);
  scene.bodies[0].collides = false;
  const auto free = make_truth("oscillator", scene, 5);
  for (double t = 0; t <= 5; t += 0.07) {
    BOOST_TEST((at(*struck, t).position - at(*free, t).position).norm() <= struck->error(t) + free->error(t));
    BOOST_TEST((at(*struck, t).velocity - at(*free, t).velocity).norm() < 1e-13);
  }
}

BOOST_AUTO_TEST_CASE(an_elastic_ball_comes_back_after_a_shorter_swing) {
  const double R = 0.5, d = 0.25, cycle = (2 * std::numbers::pi - 2 * std::acos(d / R)) / kFrequency;  // 2/3 s
  const auto truth = make_truth("sprung-ball", swing(-R, 0, d, 1), 10);
  for (int n = 0; n < 15; ++n) {
    for (const double t : {0.0, 0.1, 0.3, 0.5, 0.6}) {
      BOOST_TEST((at(*truth, n * cycle + t).position - at(*truth, t).position).norm() < 1e-13);
    }
    // At the blow, a third of a second after it was furthest out, it is at the wall.
    BOOST_TEST(std::abs(at(*truth, (n + 0.5) * cycle).position.x() - d) < 1e-13);
  }
}

BOOST_AUTO_TEST_CASE(each_blow_leaves_its_share_of_the_speed_and_the_spring_keeps_the_rest) {
  const double d = 0.2, e = 0.8;
  for (const double speed : {0.0, 2.0, -2.0}) {
    const auto truth = make_truth("sprung-ball", swing(-0.4, speed, d, e), 6);
    const auto energy = [&](double t) {
      const BodyState now = at(*truth, t);
      return now.velocity.squaredNorm() + std::pow(kFrequency * now.position.x(), 2);
    };
    double before = energy(0);
    int blows = 0;
    constexpr double dt = 1e-3;
    for (double t = dt; t < 6; t += dt) {
      BOOST_TEST(at(*truth, t).position.x() <= d + truth->error(t));
      const double now = energy(t), at_wall = std::pow(kFrequency * d, 2);
      if (std::abs(now - before) > 1e-9) {
        BOOST_TEST(std::abs((now - at_wall) / (before - at_wall) - e * e) < 1e-9);
        ++blows;
      }
      before = now;
    }
    BOOST_TEST(blows >= 6);  // one for each free swing, at least
  }
}

BOOST_AUTO_TEST_CASE(what_it_does_not_hold_for_is_refused) {
  const auto refused = [](auto change, const std::string& why) {
    Scene scene = swing(-0.4, 0, 0.2, 1);
    change(scene);
    try {
      make_truth("sprung-ball", scene, 1);
    } catch (const InputError& error) {
      return std::string(error.what()).find(why) != std::string::npos;
    }
    return false;
  };
  BOOST_TEST(refused([](Scene& s) { s.gravity = {0, 0, -1}; }, "gravity"));
  BOOST_TEST(refused([](Scene& s) { s.springs[0].damping = 1; }, "damper"));
  BOOST_TEST(refused([](Scene& s) { s.springs[0].stiffness = 0; }, "no stiffness"));
  BOOST_TEST(refused([](Scene& s) { s.springs[0].point_b = {0, 0.1, 0}; }, "at its centre"));
  BOOST_TEST(refused([](Scene& s) { s.springs[0].point_a = {-3, 1, 0}; }, "square to the wall"));
  BOOST_TEST(refused([](Scene& s) { s.bodies[0].velocity = {1, 1, 0}; }, "square to the wall"));
  BOOST_TEST(refused([](Scene& s) { s.bodies[0].angular_velocity = {1, 0, 0}; }, "turns"));
  BOOST_TEST(refused([](Scene& s) { s.bodies[0].velocity = {100, 0, 0}; }, "other end"));
  BOOST_TEST(refused([](Scene& s) { s.bodies[0].position = {0.3, 0, 0}; }, "in the wall"));
  BOOST_TEST(refused([](Scene& s) { s.springs[0].rest_length = 3.5; }, "presses it"));
  BOOST_TEST(refused([](Scene& s) { s.springs.clear(); }, "0 springs"));
  BOOST_TEST(refused([](Scene& s) { s.bodies.pop_back(), s.bodies[0].collides = false; }, "no wall"));
}

BOOST_AUTO_TEST_SUITE_END()
