// Verdicts exactly at their bounds, and at the first and the last of their samples.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "cases/metrics/verdict.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_thresholds)

namespace {

// A bead on a slider, without anything in play: a change of its energy is relative to 1 J.
Scene bead(double mass, double damping, double stiffness = 0) {
  Scene scene;
  scene.bodies = {test::body("bead", mass, {1, 1, 1})};
  scene.joints = {{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}, .stiffness = stiffness}};
  scene.joints[0].damping = damping;
  return scene;
}

Scene ball_and_ground(ContactLaw law) {
  Scene scene;
  scene.bodies = {test::on_its_own("ball", Sphere{0.5}, 2, {0, 0, 3}), test::plane()};
  scene.contact_default = law;
  return scene;
}

// The scene's positions, with the first body at these speeds [m/s], a second apart.
Trajectory at_speeds(const Scene& scene, const std::vector<double>& speeds) {
  Trajectory run{1, {}};
  for (const double speed : speeds) {
    BodyTable table(scene.bodies.size());
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      table.columns().set_body(i, {scene.bodies[i].position, Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
    table.columns().set_velocity(0, {speed, 0, 0});
    run.samples.push_back({static_cast<double>(run.samples.size()), table});
  }
  return run;
}

// The run itself, good for so many samples, with 1 J in play.
TruthSamples truth_of(const Trajectory& run, std::size_t good) {
  TruthSamples truth;
  truth.largest_kinetic_energy = 1;
  for (std::size_t n = 0; n < run.samples.size(); ++n)
    truth.bodies.push_back(run.samples[n].bodies), truth.error.push_back(n < good ? 0 : 1);
  return truth;
}

Stability verdict_of_speeds(const Scene& scene, const std::vector<double>& speeds) {
  const Trajectory run = at_speeds(scene, speeds);
  return verdict_on({scene, run, nullptr, 0});
}

std::string word_of_speeds(const Scene& scene, const std::vector<double>& speeds) {
  return word_of(verdict_of_speeds(scene, speeds).verdict);
}

// Bodies at these places at 0, 1, 2, ... s.
Stability verdict_of_places(const Scene& scene, std::size_t body, const std::vector<Vec3>& places) {
  Trajectory run = at_speeds(scene, std::vector<double>(places.size(), 0.0));
  for (std::size_t n = 0; n < places.size(); ++n) run.samples[n].bodies.columns().set_position(body, places[n]);
  return verdict_on({scene, run, nullptr, 0});
}

}  // namespace

// 2 kg at 1 m/s have 1 J.
BOOST_AUTO_TEST_CASE(a_drift_of_just_a_hundredth_and_a_gain_of_just_half_of_that_are_none) {
  const auto word = [](double mass, double damping) {
    const Scene scene = bead(mass, damping);
    const Trajectory run = at_speeds(scene, {0, 0, 1});
    const TruthSamples unknown = truth_of(run, 0);
    return word_of(verdict_on({scene, run, &unknown, 0}).verdict);
  };
  BOOST_TEST(word(0.02, 0) == "stable");
  BOOST_TEST(word(0.0201, 0) == "drifting");
  BOOST_TEST(word(0.01, 1) == "stable");
  BOOST_TEST(word(0.0101, 1) == "gaining");
}

BOOST_AUTO_TEST_CASE(the_tenths_of_a_short_run_are_single_samples) {
  const Stability drift = verdict_of_speeds(bead(2, 0), {0, 0, 1});
  BOOST_TEST(drift.amount == 1);
  BOOST_TEST(drift.why.starts_with("from the first to the last tenth of 2 s the energy moved by +100 %"), drift.why);
  BOOST_TEST(verdict_of_speeds(bead(2, 0), {0, 1, 1, 1, 1, 1, 1, 1, 1, 2}).amount == 4);
}

// In twenty samples tenths are pairs: 1 J and 1.44 J in the last of them.
BOOST_AUTO_TEST_CASE(what_oscillates_gains_by_means_of_tenths_up_to_the_last) {
  Scene sprung = bead(2, 1);
  sprung.springs = {test::spring(kWorld, Vec3::Zero(), 0, Vec3::Zero(), 1, 0)};
  std::vector<double> speeds(20, 0.0), shaking(20, 0.0);
  speeds[18] = 1, speeds[19] = 1.2;
  for (std::size_t n = 1; n < shaking.size(); n += 2) shaking[n] = 1;
  for (const Scene& scene : {sprung, bead(2, 1, 2)}) {
    const Stability gained = verdict_of_speeds(scene, speeds);
    BOOST_TEST(word_of(gained.verdict) == "gaining");
    BOOST_TEST(gained.amount == 1.22, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(gained.time == 19);
    BOOST_TEST(word_of_speeds(scene, shaking) == "stable");
  }
  Scene two = bead(2, 1);
  two.joints.push_back(two.joints[0]), two.joints[1].stiffness = 2;
  BOOST_TEST(word_of_speeds(two, shaking) == "stable");
  // Without a spring each sample counts.
  BOOST_TEST(word_of_speeds(bead(2, 1), shaking) == "gaining");
}

BOOST_AUTO_TEST_CASE(where_contact_keeps_the_energy_both_drift_and_gain_are_asked_in_that_order) {
  const Scene elastic = ball_and_ground({1, 0});
  const std::string why = verdict_of_speeds(elastic, {1, 1, 1}).why;
  BOOST_TEST(why.starts_with("from the first to the last tenth"), why);
  BOOST_TEST(why.find("; nothing drives the energy") != std::string::npos, why);
  BOOST_TEST(word_of_speeds(elastic, {1, 0, 1}) == "gaining");  // what it lost before
}

BOOST_AUTO_TEST_CASE(what_is_driven_as_its_truth_is_gains_nothing_of_its_own) {
  Scene pushed = ball_and_ground({0, 0.5});
  pushed.forces = {{.body = 0, .force = {1, 0, 0}}};
  const Trajectory run = at_speeds(pushed, {0, 1, 2, 3});
  const TruthSamples truth = truth_of(run, 4);
  const Stability verdict = verdict_on({pushed, run, &truth, 0});
  BOOST_TEST(word_of(verdict.verdict) == "stable");
  BOOST_TEST(verdict.why.find("nothing drives") == std::string::npos, verdict.why);
}

// Bodies that start apart may overlap a fixed body by their thickness, in any order of the scene.
BOOST_AUTO_TEST_CASE(a_fixed_body_that_is_first_is_gone_into_as_deep) {
  Scene scene;
  scene.bodies = {test::plane(), test::on_its_own("ball", Sphere{0.5}, 2, {0, 0, 0.5})};
  BOOST_TEST(word_of(verdict_of_places(scene, 1, {{0, 0, 0.5}, {0, 0, -0.5}}).verdict) == "stable");
  const Stability deep = verdict_of_places(scene, 1, {{0, 0, 0.5}, {0, 0, -0.51}});
  BOOST_TEST(word_of(deep.verdict) == "overlapping");
  BOOST_TEST(deep.body == 1);
  BOOST_TEST(deep.why.find("at 1 s 'ball' and 'ground' overlap by 1.01 m") != std::string::npos, deep.why);
}

BOOST_AUTO_TEST_CASE(of_two_that_move_neither_may_hold_the_others_middle) {
  for (const bool small_first : {true, false}) {
    Scene scene;
    scene.bodies = {test::on_its_own("a", Sphere{small_first ? 0.1 : 1}, 2, {5, 0, 0}),
                    test::on_its_own("b", Sphere{small_first ? 1 : 0.1}, 2, {0, 0, 0})};
    // 1.1 m less the overlap.
    BOOST_TEST(word_of(verdict_of_places(scene, 0, {{5, 0, 0}, {1.01, 0, 0}}).verdict) == "stable");
    const Stability deep = verdict_of_places(scene, 0, {{5, 0, 0}, {0.99, 0, 0}, {0.98, 0, 0}, {0.98, 0, 0}});
    BOOST_TEST(word_of(deep.verdict) == "overlapping");
    BOOST_TEST(deep.amount == 0.12, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(deep.time == 2);  // the first at which it is deepest
  }
}

// A box on the ground that lies elsewhere from 3 s on.
BOOST_AUTO_TEST_CASE(what_falls_has_collapsed_up_to_the_last_instant_that_the_truth_knows) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("box", Box{{1, 1, 1}}, 2, {0, 0, 0.5}), test::plane()};
  scene.contact_default = {0, 0.5};
  const Trajectory rest = at_speeds(scene, {0, 0, 0, 0, 0, 0});
  Trajectory run = rest;
  for (std::size_t n = 3; n < 6; ++n) run.samples[n].bodies.columns().set_position(0, {9, 0, 0.5});
  for (const auto& [good, word] :
       {std::pair{6, "collapsed"}, {5, "collapsed"}, {4, "collapsed"}, {3, "stable"}, {2, "stable"}, {0, "stable"}}) {
    const TruthSamples truth = truth_of(rest, good);
    const Stability verdict = verdict_on({scene, run, &truth, 0});
    BOOST_TEST(word_of(verdict.verdict) == word, good);
    if (verdict.verdict == Verdict::collapsed) BOOST_TEST((verdict.time == 3 && verdict.body == 0));
  }
}

BOOST_AUTO_TEST_CASE(a_gain_from_the_whole_of_what_is_in_play_on_has_no_decimals) {
  const auto phrase = [](double amount) { return phrase_of({Verdict::gaining, 0, kWorld, "", amount}); };
  BOOST_TEST(phrase(0.0567) == "gaining 5.7 %");
  BOOST_TEST(phrase(0.99) == "gaining 99 %");
  BOOST_TEST(phrase(1) == "gaining 100 %");
  BOOST_TEST(phrase(1.567) == "gaining 157 %");
}

// 2 µg at 1 m/s are 1e-9 of the 1 J that a scene has where nothing else is in play.
BOOST_AUTO_TEST_CASE(a_truth_that_has_just_a_billionth_of_what_the_scene_has_hardly_moves) {
  const auto kinetic = [](double mass, double speed, double height) {
    Scene scene;
    scene.gravity = {0, 0, height > 0 ? -10.0 : 0.0};
    scene.bodies = {test::body("bead", mass, {1, 1, 1})};
    const test::StatedTruth truth([=](double t) {
      return BodyState{{0, 0, t * height}, Quat::Identity(), {speed, 0, 0}, Vec3::Zero()};
    });
    return energy_extremes(scene, &truth, 1).kinetic;
  };
  BOOST_TEST(kinetic(2e-9, 1, 0) == 1);
  BOOST_TEST(kinetic(2.4e-9, 1, 0) == 1.2e-9, boost::test_tools::tolerance(1e-12));
  // Relative to 100 J, which a start at 10 m/s has.
  Scene scene;
  scene.bodies = {test::body("bead", 2, {1, 1, 1})};
  scene.bodies[0].velocity = {10, 0, 0};
  for (const auto& [speed, in_play] : {std::pair{2e-4, 100.0}, {4e-4, 1.6e-7}}) {
    const test::StatedTruth creeping([&](double) {
      return BodyState{Vec3::Zero(), Quat::Identity(), {speed, 0, 0}, Vec3::Zero()};
    });
    BOOST_TEST(energy_extremes(scene, &creeping, 1).kinetic == in_play, boost::test_tools::tolerance(1e-12));
  }
  // Its energy changes, though it says that it has no speed: 2 kg lifted by 3 m.
  BOOST_TEST(kinetic(2, 0, 3) == 0);
}

BOOST_AUTO_TEST_CASE(of_two_bodies_with_as_much_energy_the_first_is_named) {
  Scene scene;
  scene.bodies = {test::body("one", 2, {1, 1, 1}), test::body("other", 2, {1, 1, 1})};
  Trajectory run = at_speeds(scene, {0, 3, 3});
  for (Sample& sample : run.samples) sample.bodies.columns().set_velocity(1, {0, sample.time > 0 ? 3.0 : 0.0, 0});
  BOOST_TEST(judge_stability({scene, run, nullptr, 0}, {}, 1).body == 0);
}

BOOST_AUTO_TEST_SUITE_END()
