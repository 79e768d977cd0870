// Properties of joints over many steps: their gap with every method, and the energy with symplectic ones.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/joints/joints.h"
#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_joints_long_run)

namespace {

// Each step ends on the joints, so nothing can accumulate beyond rounding. semi-implicit-euler stops at 1e-11 of the
// longest arm of a body, 2 m. The bound is 1e-10 m over a million steps.
void check_gaps(const Scene& scene, double end, double rounding) {
  const System system(scene);
  Joints joints(scene, system);
  for (const Integrator& row : integrators()) {
    if (!row.takes_joints || row.adaptive) continue;
    const BodyTable at_end = test::state_after(scene, row.name, 1e-3, end);
    BOOST_TEST_CONTEXT(row.name) {
      BOOST_TEST(joints.gap(at_end.columns()) < (row.name == "semi-implicit-euler" ? 2e-11 : rounding));
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(no_method_lets_joints_part_in_ten_thousand_steps) {
  for (const char* id : {"joints/double-pendulum", "mechanisms/four-bar"}) {
    BOOST_TEST_CONTEXT(id) { check_gaps(test::suite_scene(id), 10, 1e-13); }
  }
}

// How far from the origin a mechanism hangs is no arm of its own: at a kilometre semi-implicit-euler stopped at 1e-8 m.
// The others stop at 16 roundings of a kilometre.
BOOST_AUTO_TEST_CASE(joints_hold_as_well_a_kilometre_away) {
  for (const char* id : {"joints/double-pendulum", "mechanisms/four-bar"}) {
    Scene scene = test::suite_scene(id);
    const Vec3 away(600, -800, 0);
    for (Body& body : scene.bodies) body.position += away;
    for (Joint& joint : scene.joints) {
      std::visit(
          [&](auto& type) {
            if constexpr (requires { type.anchor; }) type.anchor += away;
          },
          joint.type);
    }
    BOOST_TEST_CONTEXT(id) { check_gaps(scene, 1, 16 * 2.3e-16 * 1000); }
  }
}

// A hundred periods. The deviation of the energy from its start oscillates with the motion. Its largest value over the
// second half equals that over the first, to a thousandth, which is the effect of other phases of the same swing.
BOOST_AUTO_TEST_CASE(symplectic_methods_keep_the_energy_of_a_double_pendulum_bounded) {
  const Scene scene = test::suite_scene("joints/double-pendulum");
  for (const char* method : {"velocity-verlet", "moser-veselov", "symplectic4"}) {
    const auto world = CoreEngine().load(scene, {.method = method, .options = {}});
    Snapshot now;
    world->read(now);
    const double at_start = energy(scene, now.bodies());
    double largest[2] = {0, 0};
    for (const int half : {0, 1}) {
      for (int n = 0; n < 10000; ++n) {
        world->step(0.01);
        world->read(now);
        largest[half] = std::max(largest[half], std::abs(energy(scene, now.bodies()) - at_start));
      }
    }
    BOOST_TEST_CONTEXT(method << ": " << largest[0] << " J, then " << largest[1]) {
      BOOST_TEST(largest[0] > 0);
      BOOST_TEST(largest[1] < 1.02 * largest[0]);
      BOOST_TEST(largest[1] < 1e-4 * std::abs(at_start));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
