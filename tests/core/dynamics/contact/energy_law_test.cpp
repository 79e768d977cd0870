// No impact adds energy, with any method, integrator and friction. Cubes and balls fly in a closed room without
// gravity. Bodies with equal moments change their energy only in impacts.
#include <random>

#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_energy_law)

namespace {

Scene room(unsigned seed, double friction) {
  std::mt19937 random(seed);
  // Its own numbers, so that they are the same with every library.
  const auto number = [&](double most) { return most * (static_cast<double>(random()) / 2147483648.0 - 1); };
  const auto vector = [&](double most) {
    const double x = number(most), y = number(most), z = number(most);
    return Vec3(x, y, z);
  };
  Scene scene;
  scene.contact_default = {1, friction};
  for (int i = 0; i < 6; ++i) {
    const Vec3 place(i % 2 ? 0.5 : -0.5, i / 2 % 2 ? 0.5 : -0.5, i < 4 ? -0.5 : 0.5);
    Body body = i % 3 == 0 ? solid("ball", Sphere{0.2}, place) : solid("cube", Box{{0.3, 0.3, 0.3}}, place, 2);
    body.velocity = vector(3), body.angular_velocity = vector(5);
    body.orientation = rotation_by(vector(3));
    scene.bodies.push_back(body);
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) scene.bodies.push_back(floor_at(sign * Vec3::Unit(axis), -1));
  }
  return scene;
}

// Relative to the initial energy.
double largest_gain(const Scene& scene, const std::string& method, const std::string& integrator, int steps) {
  ContactRun run(scene, method, integrator);
  const double start = rigor::energy(scene, run.state());
  double least = start, gain = 0;
  for (int n = 0; n < steps; ++n) {
    run.step(1.0 / 100);
    const double now = rigor::energy(scene, run.state());
    gain = std::max(gain, (now - least) / start), least = std::min(least, now);
  }
  return gain;
}

}  // namespace

BOOST_AUTO_TEST_CASE(no_impact_adds_energy) {
  for (const double friction : {0.0, 1.0}) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
      for (const char* integrator : {"velocity-verlet", "rk4", "semi-implicit-euler"}) {
        BOOST_TEST_CONTEXT("impulse, " << integrator << ", friction " << friction << ", seed " << seed)
        BOOST_TEST(largest_gain(room(seed, friction), "impulse", integrator, 200) < 1e-11);
      }
      // The fourth-order turning of a cube at 10 rad/s errs by (w h)⁵/120 of its share.
      BOOST_TEST_CONTEXT("event, friction " << friction << ", seed " << seed)
      BOOST_TEST(largest_gain(room(seed, friction), "event", "velocity-verlet", 100) < 1e-11);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
