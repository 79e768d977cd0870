// Each method's observed order with joints: one hinge, two hinges, fast-spinning bodies, and loops with redundant rows
// in a plane (rank 17 of 20) and in space (29 of 30).
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/dynamics/integrators/integrator.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/core/dynamics/joints/published_states.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_joints_order)

namespace {

constexpr double kEnd = 0.5;  // s

double error_of(const Scene& scene, const test::PublishedState& published, const std::string& method, double dt) {
  const BodyTable found = test::state_after(scene, method, dt, kEnd);
  const auto d = test::difference(found.columns().body(test::body_index(scene, published.body)), published.state);
  return std::hypot(d.pose, d.velocity);
}

// So long that errors are above rounding, so short that they fall as a power of dt. A gyroscope at 50 rad/s needs a
// tenth or a fifth of it.
double coarsest_step(int order) {
  return order == 1 ? 1.0 / 200 : order == 2 ? 1.0 / 100 : order == 4 ? 1.0 / 50 : 0.1;
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_method_that_takes_joints_keeps_its_order_over_two_halvings) {
  const std::vector<std::string> scenes = {"joints/pendulum-90", "joints/double-pendulum", "joints/gyroscope",
                                           "mechanisms/four-bar", "mechanisms/iftomm-a04"};
  int methods = 0, judged = 0;
  for (const Integrator& row : integrators()) {
    if (!row.takes_joints || row.adaptive) continue;
    ++methods;
    for (const test::PublishedState& published : test::kPublishedStates) {
      if (published.time != kEnd || std::find(scenes.begin(), scenes.end(), published.scene) == scenes.end()) continue;
      const Scene scene = test::suite_scene(published.scene);
      const bool spins = published.scene == std::string("joints/gyroscope");
      const double dt = coarsest_step(row.order) / (!spins ? 1 : row.order == 8 ? 5 : 10);
      const double errors[] = {error_of(scene, published, row.name, dt), error_of(scene, published, row.name, dt / 2),
                               error_of(scene, published, row.name, dt / 4)};
      for (int k = 0; k < 2; ++k) {
        // The level of rounding and of the published state's own error; only larger errors are judged.
        if (errors[k + 1] < 3 * published.error + 1e-13) continue;
        ++judged;
        BOOST_TEST_CONTEXT(row.name << ", " << published.scene << ": " << errors[k] << " to " << errors[k + 1])
        BOOST_TEST(std::log2(errors[k] / errors[k + 1]) > row.order - 0.35);
      }
    }
  }
  BOOST_TEST(methods == 8);
  BOOST_TEST(judged >= 75);  // of 80: the eighth order's last halvings end below rounding
}

BOOST_AUTO_TEST_SUITE_END()
