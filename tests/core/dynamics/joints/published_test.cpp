// The core's best method against states that others have worked out, for each joint and for mechanisms whose rows
// repeat each other.
#include <boost/test/unit_test.hpp>

#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/core/dynamics/joints/published_states.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_joints_published)

namespace {

// Mechanisms that pass a singular position, where dormand-prince cannot meet its tolerance.
bool is_singular(const std::string& id) {
  return id == "mechanisms/slider-crank-singular" || id == "mechanisms/iftomm-a02-2";
}

// Stiff, or of grams and milliseconds: in steps that a method of order 4 resolves.
double step_for(const std::string& id) {
  if (id == "mechanisms/iftomm-a03") return 1e-4;
  if (id == "mechanisms/iftomm-a05") return 1e-3;
  return 1e-2;
}

}  // namespace

// dormand-prince holds each inner step to 1e-12 of 1 + the value; there are some twenty in a second of slow motion, and
// more by the rate of what turns. Errors then grow with the motion's own spreading, up to tenfold within these times.
BOOST_AUTO_TEST_CASE(dormand_prince_meets_every_published_state_of_a_regular_mechanism) {
  int compared = 0;
  for (const test::PublishedState& published : test::kPublishedStates) {
    if (is_singular(published.scene)) continue;
    const Scene scene = test::suite_scene(published.scene);
    const BodyTable found = test::state_after(scene, "dormand-prince", step_for(published.scene), published.time);
    const auto d = test::difference(found.columns().body(test::body_index(scene, published.body)), published.state);
    double fastest = 1;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      fastest = std::max(fastest, found.columns().angular_velocity(i).norm());
    const double allowed = 10 * published.error + 2e-11 * (1 + published.time * fastest);
    BOOST_TEST_CONTEXT(published.scene << " at " << published.time << " s, " << published.body) {
      BOOST_TEST(d.pose < allowed);
      BOOST_TEST(d.velocity < 10 * fastest * allowed);
    }
    ++compared;
  }
  BOOST_TEST(compared >= 70);
}

// Passing a singular position in fixed steps costs digits, but neither the branch nor the joints. The error is that of
// the few steps beside it, which lose order. Measured 2e-9 and 5e-12 m.
BOOST_AUTO_TEST_CASE(rk4_passes_singular_positions_on_the_right_branch) {
  for (const test::PublishedState& published : test::kPublishedStates) {
    if (!is_singular(published.scene)) continue;
    const Scene scene = test::suite_scene(published.scene);
    const BodyTable found = test::state_after(scene, "rk4", 1e-3, published.time);
    const auto d = test::difference(found.columns().body(test::body_index(scene, published.body)), published.state);
    BOOST_TEST_CONTEXT(published.scene << " at " << published.time << " s") { BOOST_TEST(d.pose < 1e-8); }
  }
}

BOOST_AUTO_TEST_SUITE_END()
