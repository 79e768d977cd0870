#include <boost/test/unit_test.hpp>

#include "core/dynamics/model/energy.h"
#include "core/engine/run_name.h"
#include "tests/cases/judged.h"
#include "tests/cases/scripted_engine.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_stability)

namespace {

const Engine& core() { return find_engine(engines(), "core"); }

Stability verdict_on(const Scene& scene, const std::string& method, double dt, double duration) {
  const auto truth = make_truth("reference", scene, duration);
  const double largest = energy_extremes(scene, truth.get(), duration).kinetic;
  const Simulation run = simulate(core(), test::core_method(method), scene, dt, duration);
  const TruthSamples samples = test::sampled(*truth, run.trajectory, scene, largest);
  const double stagger = method_of(core().info(), test::core_method(method)).leapfrog_stagger;
  return judge_stability({scene, run.trajectory, &samples, stagger}, run.not_finite, largest);
}

}  // namespace

BOOST_AUTO_TEST_CASE(explicit_euler_blows_the_springs_up_when_it_is_known_to) {
  struct Row {
    Scene scene;
    double time;
  };
  // 0.40 s and 0.33 s to the step of 1/30 s.
  for (const Row& row : {Row{test::fixed_spring(), 12.0 / 30}, {test::body_springs(), 10.0 / 30}}) {
    const Stability verdict = verdict_on(row.scene, "explicit-euler", 1.0 / 30, 5);
    BOOST_TEST(word_of(verdict.verdict) == "blown up");
    BOOST_TEST(verdict.time == row.time, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(verdict.body == 0);
    BOOST_TEST_CONTEXT(verdict.why)
    BOOST_TEST(verdict.why.find("'" + row.scene.bodies[0].name + "'") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(a_bounded_oscillation_is_stable_and_a_steady_loss_drifts) {
  // RK4 damps an oscillation by (w dt)^6 / 144 of its energy a step; semi-implicit Euler's stays within bounds.
  BOOST_TEST(word_of(verdict_on(test::fixed_spring(), "semi-implicit-euler", 1.0 / 30, 30).verdict) == "stable");
  BOOST_TEST(word_of(verdict_on(test::fixed_spring(), "rk4", 1.0 / 30, 30).verdict) == "drifting");
  BOOST_TEST(word_of(verdict_on(test::fixed_spring(), "rk4", 1.0 / 240, 30).verdict) == "stable");
}

BOOST_AUTO_TEST_CASE(what_a_damper_takes_is_no_drift) {
  BOOST_TEST(word_of(verdict_on(test::coupled_bodies(0.5), "rk4", 1.0 / 240, 10).verdict) == "stable");
}

BOOST_AUTO_TEST_CASE(a_state_that_is_not_finite_has_blown_up_with_its_body_and_time) {
  Scene scene = test::tumbling_body();
  test::Script script;
  script.play = [](int step, MutableBodyColumns bodies) {
    bodies.set_position(0, Vec3::Zero());
    if (step == 7) bodies.column(3)[0] = std::nan("");
  };
  const Simulation run = simulate(test::ScriptedEngine(script), {}, scene, 0.5, 10);
  const Stability verdict = judge_stability({scene, run.trajectory, nullptr, 0}, run.not_finite, 1);
  BOOST_TEST(word_of(verdict.verdict) == "blown up");
  BOOST_TEST(verdict.time == 3.5);
  BOOST_TEST(verdict.body == 0);
  BOOST_TEST(verdict.why == "at 3.5 s the state of 'top' is no longer finite");
}

BOOST_AUTO_TEST_CASE(the_largest_kinetic_energy_is_the_truths_or_what_the_start_can_give) {
  const Scene fall = test::dropped_sphere(1);
  const auto truth = make_truth("bounce", fall, 3);
  // m g h, met between two of the samples a millisecond apart: 5 m/s · 10 m/s² · 1 ms is 0.4 % of v²/2.
  BOOST_TEST(energy_extremes(fall, truth.get(), 3).kinetic == 100 * 9.8 * 1.37, boost::test_tools::tolerance(4e-3));
  Scene scene;
  scene.gravity = {0, -10, 0};
  scene.bodies = {test::body("a", 2, {1, 1, 1})};
  scene.bodies[0].velocity = {3, 0, 0};
  // Thrown along gravity at 3 m/s it has 23 m/s after 2 s, and no way to have more.
  BOOST_TEST(energy_extremes(scene, nullptr, 2).kinetic == 529, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(a_truth_in_which_no_body_moves_is_still) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::body("cart", 2, {1, 1, 1}, {0.3, 0.1, 0.7})};
  scene.joints = {{kWorld, 0, SliderJoint{Vec3::UnitX()}}};
  const auto is_still = [&] { return energy_extremes(scene, make_truth("reference", scene, 2).get(), 2).is_still; };
  BOOST_TEST(is_still());
  scene.bodies[0].velocity.x() = 1e-6;
  BOOST_TEST(!is_still());
  BOOST_TEST(!energy_extremes(scene, nullptr, 2).is_still);  // not known
}

// A pole of 1 m balanced on a hinge and pulled sideways by 1e-6 of its weight. Its truth reaches 3e-11 J in half a
// second. A joint that yields by a tenth of a micrometre under 10 N has 1e-6 J. None of these counts as blown up.
BOOST_AUTO_TEST_CASE(a_pole_that_is_balanced_has_what_it_can_fall_in_play) {
  Scene scene;
  scene.gravity = {1e-5, 0, -10};
  scene.bodies = {test::body("pole", 1, {0.1, 0.1, 0.1}, {0, 0, 0.5})};
  scene.joints = {{kWorld, 0, HingeJoint{{0, 0, 0}, {0, 1, 0}}}};
  const auto truth = make_truth("reference", scene, 0.5);
  const double in_play = energy_extremes(scene, truth.get(), 0.5).kinetic;
  BOOST_TEST(in_play == energy_extremes(scene, nullptr, 0.5).kinetic);
  for (const char* engine : {"ode", "bullet"}) {
    const Settings settings = parse_run_name(engine, infos_of(engines())).settings;
    const Simulation run = simulate(find_engine(engines(), engine), settings, scene, 1.0 / 240, 0.5);
    BOOST_TEST(
        word_of(judge_stability({scene, run.trajectory, nullptr, 0}, run.not_finite, in_play).verdict) == "stable",
        engine);
  }
  scene.gravity.x() = 1;  // now it falls, and what it comes to counts
  const auto falling = make_truth("reference", scene, 0.5);
  BOOST_TEST(energy_extremes(scene, falling.get(), 0.5).kinetic < 0.5 * in_play);
}

// k = 400 N/m, c = 200 N s/m, 1 kg let go at rest 2 m away: it creeps back at x' = -k x / c, never faster than 4 m/s, 8
// J, while 800 J are lost. No run that does the same has blown up, and one that gains ten times those 800 J has.
BOOST_AUTO_TEST_CASE(a_weight_that_dampers_let_creep_back_has_not_blown_up) {
  Scene scene;
  scene.bodies = {test::body("weight", 1, {1, 1, 1}, {2, 0, 0})};
  scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 400, 0, 200)};
  const auto truth = make_truth("oscillator", scene, 5);
  const double kinetic = energy_extremes(scene, truth.get(), 5).kinetic,
               change = energy_extremes(scene, truth.get(), 5).change;
  BOOST_TEST(kinetic < 8);
  BOOST_TEST(change == 800, boost::test_tools::tolerance(1e-3));
  BOOST_TEST(energy_extremes(scene, nullptr, 5).change == 0);
  const Simulation run = simulate(core(), test::core_method("rk4"), scene, 1e-3, 5);
  const auto verdict = [&](const Simulation& judged, double largest_change) {
    return word_of(judge_stability({scene, judged.trajectory, nullptr, 0}, {}, kinetic, largest_change).verdict);
  };
  BOOST_TEST(verdict(run, change) == "stable");
  BOOST_TEST(verdict(run, 0) == "blown up");  // by its motion alone
  const Simulation wild = simulate(core(), test::core_method("explicit-euler"), scene, 0.02, 5);
  BOOST_TEST(verdict(wild, change) == "blown up");
}

BOOST_AUTO_TEST_SUITE_END()
