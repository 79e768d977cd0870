// The reference of jointed scenes against states that three derivations of others agree on, written apart.
#include <boost/test/unit_test.hpp>
#include <map>
#include <set>

#include "cases/truth/truth.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/core/dynamics/joints/published_states.h"

using namespace rigor;

namespace {

// What passes a singular position, where the rows in use come to depend on each other; and what takes long: a stiff
// spring, a thousand to one, a hundred links.
const std::set<std::string> kLeftOut = {"mechanisms/slider-crank-singular", "mechanisms/iftomm-a02-2",
                                        "mechanisms/iftomm-a02-40",         "mechanisms/iftomm-a05",
                                        "joints/mass-ratio-chain",          "joints/cable-100"};

}  // namespace

BOOST_AUTO_TEST_SUITE(cases_truth_solved_jointed_reference)

BOOST_AUTO_TEST_CASE(it_meets_every_published_state_within_both_errors) {
  std::map<std::string, double> last;  // s, of the states of a scene
  for (const test::PublishedState& published : test::kPublishedStates) {
    double& time = last[published.scene];
    time = std::max(time, published.time);
  }
  for (const auto& [id, seconds] : last) {
    if (kLeftOut.contains(id)) continue;
    const Scene scene = test::suite_scene(id);
    const auto truth = make_truth("reference", scene, seconds);
    BodyTable found(scene.bodies.size());
    for (const test::PublishedState& published : test::kPublishedStates) {
      if (published.scene != id) continue;
      truth->at(published.time, found.columns());
      const auto d = test::difference(found.columns().body(test::body_index(scene, published.body)), published.state);
      BOOST_TEST_CONTEXT(id << " at " << published.time << " s, " << published.body) {
        BOOST_TEST(truth->error(published.time) < 1e-8);
        // Three times their error, which is that of printed digits as well.
        BOOST_TEST(d.pose < 3 * published.error + truth->error(published.time) + 1e-13);
      }
    }
  }
}

// A joint that is there twice has more rows of the same rank, and the motion of one.
BOOST_AUTO_TEST_CASE(a_joint_twice_is_the_joint_once) {
  const Scene once = test::suite_scene("joints/pendulum-90");
  Scene twice = once;
  twice.joints.push_back(once.joints.front());
  const auto a = make_truth("reference", once, 2), b = make_truth("reference", twice, 2);
  BodyTable found_a(1), found_b(1);
  a->at(2, found_a.columns()), b->at(2, found_b.columns());
  BOOST_TEST((found_a.columns().position(0) - found_b.columns().position(0)).norm() < a->error(2) + b->error(2));
}

BOOST_AUTO_TEST_SUITE_END()
