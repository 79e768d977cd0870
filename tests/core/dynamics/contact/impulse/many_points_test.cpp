// Two bodies may touch at more than four points: those of several shapes, and those on triangles.
#include <algorithm>
#include <cmath>

#include "cases/metrics/measures/shape_gap.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_impulse_many_points)

// Such pairs once shared rows with others, and states of a pile in a hollow were no numbers.
BOOST_AUTO_TEST_CASE(a_pile_in_a_hollow_of_triangles_comes_to_rest) {
  Heightfield hollow;
  hollow.size = {3, 3};
  constexpr std::size_t kRows = 25;
  for (std::size_t i = 0; i < kRows; ++i) {
    std::vector<double>& heights = hollow.heights.emplace_back();
    for (std::size_t k = 0; k < kRows; ++k) {
      const double x = 0.125 * static_cast<double>(k) - 1.5, y = 0.125 * static_cast<double>(i) - 1.5;
      heights.push_back(0.3 * (x * x + y * y) + 0.03 * std::sin(5 * x) * std::cos(6 * y));
    }
  }
  hollow.surface = height_surface(hollow.size, hollow.heights);
  Scene scene = on_floor({}, {0, 0.5});
  scene.bodies.back().shape = hollow;
  for (int i = 0; i < 64; ++i) {
    const Vec3 at(0.21 * (i % 4) - 0.3 + 0.001 * std::sin(i), 0.21 * (i / 4 % 4) - 0.3, 0.3 + 0.21 * (i / 16));
    scene.bodies.push_back(solid("ball " + std::to_string(i), Sphere{0.1}, at));
  }
  ContactRun run(scene, "impulse", "semi-implicit-euler");
  run.run(1.0 / 120, 360);
  double fastest = 0;
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    BOOST_TEST_REQUIRE(run.state().position(i).allFinite());
    fastest = std::max(fastest, run.state().velocity(i).norm());
  }
  BOOST_TEST(run.solver_warning() == "");
  // Balls roll without loss, so that some still rock in the hollow.
  BOOST_TEST(fastest < 0.5);
  double deepest = 0;
  for_each_near_pair(scene, run.state(), 0, [&](int, int, double gap) { deepest = std::max(deepest, -gap); });
  BOOST_TEST(deepest < 0.005);
}

BOOST_AUTO_TEST_SUITE_END()
