// The lag that each method declares between its velocities and its positions is the lag that a free fall shows.
#include <boost/test/unit_test.hpp>

#include "adapters/engines.h"
#include "cases/runner/simulate.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_stagger)

// Under a constant acceleration a, v_n - (x_n - x_(n-1))/h = (1/2 - s) a h for velocities that lag by s steps.
BOOST_AUTO_TEST_CASE(a_free_fall_shows_the_declared_stagger) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::body("stone", 2, {0.1, 0.1, 0.1}, {0, 0, 5})};
  scene.bodies[0].velocity = {0, 0, 3};
  const double h = 0.02;
  for (const EngineInfo& engine : engines().infos()) {
    for (const MethodInfo& method : engine.methods) {
      if (method.adaptive) continue;  // the lag is a share of its inner steps
      Settings settings;
      settings.method = method.name;
      if (!why_unsupported(engine, settings, scene, h).empty()) continue;
      const Trajectory run = simulate(find_engine(engines(), engine.name), settings, scene, h, 10 * h).trajectory;
      BOOST_TEST_REQUIRE(run.samples.size() == 11u);
      const auto at = [&](std::size_t n) { return run.samples[n].bodies.columns().body(0); };
      const double mean = (at(10).position.z() - at(9).position.z()) / h;
      const double found = 0.5 - (at(10).velocity.z() - mean) / (scene.gravity.z() * h);
      // Positions of 5 m are rounded to 1e-15 m, divided by a h² = 4e-3 m.
      BOOST_TEST(std::abs(found - method.leapfrog_stagger) < 1e-9,
                 engine.name << ":" << method.name << " declares " << method.leapfrog_stagger << ", shows " << found);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
