// When a scene counts as built to stand, when it has fallen, and when a run has blown up.
#include "cases/metrics/measures/built_at_rest.h"

#include <boost/test/unit_test.hpp>

#include "cases/metrics/measures/contact/overlaps.h"
#include "core/dynamics/model/energy.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_built_at_rest)

namespace {

// Two boxes of 1 m, one on the other, on the ground; each `play` above what it stands on.
Scene stack(double play = 0) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::plane(), test::on_its_own("lower", Box{{1, 1, 1}}, 2, {0, 0, 0.5 + play}),
                  test::on_its_own("upper", Box{{1, 1, 1}}, 2, {0, 0, 1.5 + 2 * play})};
  scene.contact_default = {0, 0.5};
  return scene;
}

Trajectory standing(const Scene& scene, int samples) {
  Trajectory run{1, {}};
  for (int n = 0; n < samples; ++n) {
    BodyTable table(scene.bodies.size());
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      table.columns().set_body(i, {scene.bodies[i].position, Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
    run.samples.push_back({static_cast<double>(n), table});
  }
  return run;
}

std::string why_not(const Scene& scene, const TruthSamples* truth = nullptr) {
  const Trajectory run = standing(scene, 3);
  return why_not_built_at_rest({scene, run, truth, 0});
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_stands_free_and_touches_is_built_to_stand_and_all_else_says_why_it_is_not) {
  BOOST_TEST(why_not(stack()) == "");
  BOOST_TEST(why_not(stack(0.9e-3)) == "");
  BOOST_TEST(why_not(stack(1.1e-3)) == "a body starts without touching another");
  Scene beside = stack();
  beside.bodies.push_back(test::on_its_own("post", Box{{1, 1, 1}}, 1, {9, 9, 9}));
  beside.bodies[3].fixed = true;
  BOOST_TEST(why_not(beside) == "");
  const auto with = [](const std::function<void(Scene&)>& change) {
    Scene scene = stack();
    change(scene);
    return why_not(scene);
  };
  BOOST_TEST(with([](Scene& s) { s.bodies[2].position.z() = 1.6; }) == "a body starts without touching another");
  BOOST_TEST(with([](Scene& s) { s.bodies[2].velocity.x() = 1e-9; }) == "bodies move at the start");
  BOOST_TEST(with([](Scene& s) { s.bodies[1].angular_velocity.x() = 1e-9; }) == "bodies move at the start");
  BOOST_TEST(with([](Scene& s) { s.forces = {{.body = 1}}; }) == "more than gravity acts");
  BOOST_TEST(with([](Scene& s) { s.springs = {test::spring(kWorld, Vec3::Zero(), 1, Vec3::Zero(), 1, 1)}; }) ==
             "more than gravity acts");
  BOOST_TEST(with([](Scene& s) { s.joints = {{.a = kWorld, .b = 1, .type = FixedJoint{}}}; }) ==
             "more than gravity acts");
  const Scene scene = stack();
  const Trajectory none{1, {}};
  BOOST_TEST(why_not_built_at_rest({scene, none, nullptr, 0}) == "the run has no finite sample");
}

BOOST_AUTO_TEST_CASE(what_moves_in_truth_is_not_built_to_stand) {
  const Scene scene = stack();
  TruthSamples truth;
  for (const Sample& sample : standing(scene, 3).samples)
    truth.bodies.push_back(sample.bodies), truth.error.push_back(0);
  BOOST_TEST(why_not(scene, &truth) == "");
  Scene pressed = scene;
  pressed.forces = {{.body = 1, .force = {0, 0, -1}}};
  BOOST_TEST(why_not(pressed, &truth) == "");
  BOOST_TEST(why_not(pressed) == "more than gravity acts");  // no truth says that it stands
  pressed.forces[0].from = 1;
  BOOST_TEST(why_not(pressed, &truth) == "more than gravity acts");
  pressed.forces[0].from = 0, pressed.forces[0].until = 1.5;
  BOOST_TEST(why_not(pressed, &truth) == "more than gravity acts");
  for (const std::size_t body : {0, 1, 2}) {
    truth.bodies[2].columns().set_velocity(body, {0, 0, 1e-9});
    BOOST_TEST(why_not(scene, &truth) == "bodies move in truth");
    truth.bodies[2].columns().set_velocity(body, Vec3::Zero());
  }
}

// Half of the radius of the sphere round it, which is half of the cube's diagonal.
BOOST_AUTO_TEST_CASE(a_body_has_fallen_once_it_is_half_its_radius_away) {
  Scene scene = stack();
  const double far = 0.25 * std::sqrt(3);
  const auto fallen = [&](std::size_t body, double first, double second) {
    Trajectory run = standing(scene, 3);
    run.samples[1].bodies.columns().set_position(body, scene.bodies[body].position + Vec3(0, first, 0));
    run.samples[2].bodies.columns().set_position(body, scene.bodies[body].position + Vec3(0, second, 0));
    return collapse_of({scene, run, nullptr, 0});
  };
  BOOST_TEST(!fallen(1, 0.99 * far, 0.99 * far).has_value());
  const Instant late = fallen(1, 0.99 * far, 1.01 * far).value();
  BOOST_TEST(late.time == 2);
  BOOST_TEST(late.body == 1);
  BOOST_TEST(late.component == "displacement");
  BOOST_TEST(late.found == 1.01 * far, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(late.expected == 0);
  BOOST_TEST(fallen(2, 2 * far, 3 * far).value().time == 1);
  BOOST_TEST(!fallen(0, 9, 9).has_value());  // the ground
  scene.bodies[1].fixed = true;
  BOOST_TEST(!fallen(1, 9, 9).has_value());
  std::swap(scene.bodies[0], scene.bodies[2]);
  BOOST_TEST(fallen(0, 9, 9).value().body == 0);
}

BOOST_AUTO_TEST_CASE(an_overlap_counts_beyond_what_the_scene_starts_with) {
  const Scene scene = stack(-0.1);  // each starts 0.1 m in what is below it
  const Overlaps overlaps(scene);
  BodyTable table = standing(scene, 1).samples[0].bodies;
  table.columns().set_position(1, {0, 0, 0.3});
  std::map<std::pair<int, int>, Overlap> seen;
  overlaps.visit(static_cast<const BodyTable&>(table).columns(), [&](const Overlap& o) {
    seen.insert({{o.a, o.b}, o});
  });
  BOOST_TEST_REQUIRE(seen.size() == 1u);
  const Overlap with_ground = seen.begin()->second;
  BOOST_TEST(std::minmax(with_ground.a, with_ground.b).second == 1);
  BOOST_TEST(with_ground.depth == 0.1, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(with_ground.gap == -0.2, boost::test_tools::tolerance(1e-12));
}

// Ten times what is in play, either way; where contact may take energy a rise alone.
BOOST_AUTO_TEST_CASE(what_is_no_longer_bounded_is_ten_times_what_is_in_play) {
  for (const bool may_lose : {false, true}) {
    BOOST_TEST(is_bounded(10 * 3, 3, may_lose));
    BOOST_TEST(!is_bounded(10.01 * 3, 3, may_lose));
    BOOST_TEST(is_bounded(-10 * 3, 3, may_lose));
    BOOST_TEST(is_bounded(-10.01 * 3, 3, may_lose) == may_lose);
    BOOST_TEST(!is_bounded(std::nan(""), 3, may_lose));
  }
}

BOOST_AUTO_TEST_CASE(what_blew_up_names_the_body_with_the_most_energy_and_the_first_instant) {
  Scene scene = test::tumbling_body();
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].name = "other";
  Trajectory run = standing(scene, 4);
  run.samples[2].bodies.columns().set_velocity(0, {1, 0, 0});
  run.samples[2].bodies.columns().set_velocity(1, {4, 0, 0});  // 2 kg: 16 + 1 J
  run.samples[3].bodies.columns().set_velocity(0, {40, 0, 0});
  const JudgedRun judged{scene, run, nullptr, 0};
  const Stability blown_up = judge_stability(judged, {}, 1.6, 0.5);
  BOOST_TEST(word_of(blown_up.verdict) == "blown up");
  BOOST_TEST(blown_up.time == 2);
  BOOST_TEST(blown_up.body == 1);
  BOOST_TEST(blown_up.why ==
             "at 2 s the energy is 17 J from its start, more than 10 times the energy in play, 1.6 J; "
             "'other' has most of it");
  BOOST_TEST(judge_stability(judged, {}, 1.6, 1.8).time == 3);  // the larger of motion and change is in play
}

BOOST_AUTO_TEST_CASE(the_energy_in_play_is_the_largest_at_any_instant_and_its_largest_change_either_way) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::body("ball", 2, {1, 1, 1})};
  // 2 kg: 9 J at the start, 25 J at 1 s, 4 J at the end; it rises by 0.25 m, 5 J, and back.
  const test::StatedTruth truth([](double t) {
    const double speed = t < 0.5 ? 3 : t < 1.5 ? 5 : 2;
    return BodyState{{0, 0, t > 0.9 && t < 1.1 ? 0.25 : 0}, Quat::Identity(), {speed, 0, 0}, Vec3::Zero()};
  });
  const EnergyExtremes found = energy_extremes(scene, &truth, 2);
  BOOST_TEST(found.kinetic == 25, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(found.change == 25 + 5 - 9, boost::test_tools::tolerance(1e-12));
  const test::StatedTruth slowing([](double t) {
    return BodyState{Vec3::Zero(), Quat::Identity(), {t < 2 ? 3.0 : 0.0, 0, 0}, Vec3::Zero()};
  });
  BOOST_TEST(energy_extremes(scene, &slowing, 2).change == 9, boost::test_tools::tolerance(1e-12));  // at the end alone
}

BOOST_AUTO_TEST_SUITE_END()
