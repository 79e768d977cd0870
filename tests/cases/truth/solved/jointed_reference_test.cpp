// The reference of jointed scenes against states that three derivations of others agree on, written apart.
#include <boost/test/unit_test.hpp>
#include <map>
#include <set>

#include "cases/truth/solved/jointed/jointed_ways.h"
#include "cases/truth/truth.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/core/dynamics/joints/published_states.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_jointed_reference)

namespace {

// Scenes that pass a singular position, where the rows in use become dependent, and slow scenes: a stiff spring, a mass
// ratio of a thousand, a hundred links.
const std::set<std::string> kLeftOut = {"mechanisms/slider-crank-singular", "mechanisms/iftomm-a02-2",
                                        "mechanisms/iftomm-a02-40",         "mechanisms/iftomm-a05",
                                        "joints/mass-ratio-chain",          "joints/cable-100"};

// Ten rods of 0.2 m on ball joints, at rest in a crooked line, a third of a radian off the vertical. Thrice as crooked
// they whip, and roundings alone part two solutions by 4e-9 m.
Scene ten_links() {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  Vec3 anchor = Vec3::Zero();
  for (int k = 0; k < 10; ++k) {
    const Vec3 along = Vec3(0.3 + 0.05 * std::sin(k), -1, 0.05 * std::cos(2 * k)).normalized();
    Body rod;
    rod.name = "link" + std::to_string(k + 1);
    rod.mass = 0.2;
    rod.inertia = inertia_of(Box{{0.2, 0.02, 0.03}}, rod.mass);
    rod.position = anchor + 0.1 * along;
    rod.orientation = Quat::FromTwoVectors(Vec3::UnitX(), along);
    scene.joints.push_back({k - 1, k, BallJoint{anchor}});  // the first to the world, -1
    scene.bodies.push_back(rod);
    anchor += 0.2 * along;
  }
  return scene;
}

}  // namespace

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

BOOST_AUTO_TEST_CASE(ten_links_over_five_seconds_are_known_to_a_tenth_of_a_nanometre) {
  constexpr double kEnd = 5;
  const Scene scene = ten_links();
  const auto truth = make_truth("reference", scene, kEnd);
  BOOST_TEST(truth->error(kEnd) < 1e-10);
  BodyTable found(scene.bodies.size());
  truth->at(kEnd, found.columns());
  double moved = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    moved = std::max(moved, (found.columns().position(i) - scene.bodies[i].position).norm());
  BOOST_TEST(moved > 0.05);

  // The two formulations again, each to other tolerances than the truth's own: they part by no more.
  using namespace solving;
  const std::vector<double> switches = switch_times(scene, kEnd);
  const Nodes nodes = newton_euler_nodes(scene, {5, 1e-14, 1e-7}, switches);
  BOOST_TEST(nodes.complete);
  Judged judged(newton_euler_in_double(scene, nodes), scene.bodies.size(), nodes);
  compare_with_natural(judged, Precision::plain, scene, {6, 1e-13, 1e-7}, switches);
  const ReferenceSolution again = judged.solution();
  BOOST_TEST(again.complete);
  BOOST_TEST(again.errors.back() < 1e-10);
  BOOST_TEST(again.errors.back() > 0);  // they are two

  // And what shares no line with either: 1e-12 of the state in each of some thousand inner steps.
  const BodyTable by_core = test::state_after(scene, "dormand-prince", 0.01, kEnd);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    BOOST_TEST(test::difference(found.columns().body(i), by_core.columns().body(i)).pose < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
