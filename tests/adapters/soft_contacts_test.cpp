// Soft contacts of every engine that declares them, against the closed forms of a bounce and of rest.
#include <cmath>
#include <set>

#include "tests/adapters/seam_runs.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_soft_contacts)

namespace {

constexpr double kRate = 1e4, kHalf = 0.1;  // N/m, m: the ball's radius

Scene ball_over_plane(double damping, double gravity, double speed, double height) {
  Scene scene;
  scene.gravity = {0, 0, -gravity};
  scene.bodies = {test::body("ball", 1, 0.004 * Vec3::Ones(), {0, 0, kHalf + height})};
  scene.bodies[0].shape = Sphere{kHalf}, scene.bodies[0].collides = true;
  scene.bodies[0].velocity = {0, 0, -speed};
  Body ground;
  ground.name = "ground", ground.shape = Plane{Vec3::UnitZ(), 0}, ground.fixed = ground.collides = true;
  scene.bodies.push_back(ground);
  scene.contact_default = {.stiffness = kRate, .damping = damping};
  return scene;
}

// exp(-2 z acos(z)/sqrt(1 - z²)), z = c/(2 sqrt(k m)): Stronge, Impact Mechanics, 2000, section 5.1.
double share_after(double damping) {
  const double z = damping / (2 * std::sqrt(kRate));
  return std::exp(-2 * z * std::acos(z) / std::sqrt(1 - z * z));
}

double speed_after(const Run& run, double damping, double dt) {
  const auto world = run.load(ball_over_plane(damping, 0, 2, 0.05));
  return state_after(*world, dt, static_cast<int>(std::lround(0.2 / dt))).columns().velocity(0).z();
}

void for_each_matched(const Scene& scene, std::size_t least, const std::function<void(const Run&)>& check) {
  std::set<std::string> engines;
  for_each_run(scene, 1e-3, [&](const Run& run) {
    if (run.settings.track != Track::matched || run.info.name == "core") return;  // the core has its own tests
    engines.insert(run.info.name);
    check(run);
  });
  BOOST_TEST(engines.size() >= least);
}

}  // namespace

// Implicit Euler of the spring: the error halves with the step, 5 % at w dt = 0.1.
BOOST_AUTO_TEST_CASE(the_speed_after_a_bounce_converges_to_the_closed_form) {
  for (const double damping : {0.0, 40.0, 120.0}) {
    const double expected = 2 * share_after(damping);
    for_each_matched(ball_over_plane(damping, 0, 2, 0.05), 2, [&](const Run& run) {
      const double coarse = std::abs(speed_after(run, damping, 1e-3) - expected);
      const double fine = std::abs(speed_after(run, damping, 1e-4) - expected);
      BOOST_TEST_CONTEXT("damping " << damping << ": " << coarse << " and " << fine << " m/s off") {
        BOOST_TEST(coarse < 0.3);
        BOOST_TEST(fine < 0.2 * coarse + 1e-6);
      }
    });
  }
}

BOOST_AUTO_TEST_CASE(at_rest_the_overlap_is_that_of_the_spring) {
  const Scene scene = ball_over_plane(100, 9.81, 0, 0);
  for_each_matched(scene, 2, [&](const Run& run) {
    const auto world = run.load(scene);
    const double height = state_after(*world, 1e-3, 3000).columns().position(0).z();
    // After 3 s at a decay of 50/s only roundings are left of the fall.
    BOOST_TEST(std::abs(height - (kHalf - 9.81 / kRate)) < 1e-9);
  });
}

// A rigid pair beside it keeps its own law.
BOOST_AUTO_TEST_CASE(only_the_soft_pair_is_soft) {
  Scene scene = ball_over_plane(100, 9.81, 0, 0);
  Body other = scene.bodies[0];
  other.name = "rigid", other.position.x() = 1;
  scene.bodies.push_back(other);
  scene.contact_default = {};
  scene.contact_pairs = {{0, 1, {.stiffness = kRate, .damping = 100}}};
  for_each_matched(scene, 2, [&](const Run& run) {
    const auto world = run.load(scene);
    const BodyTable end = state_after(*world, 1e-3, 3000);
    BOOST_TEST(std::abs(end.columns().position(0).z() - (kHalf - 9.81 / kRate)) < 1e-9);
    BOOST_TEST(std::abs(end.columns().position(2).z() - kHalf) < 1e-4);  // a tenth of the soft one's
  });
}

BOOST_AUTO_TEST_SUITE_END()
