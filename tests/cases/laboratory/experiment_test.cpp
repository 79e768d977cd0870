// One run: what is measured after each step, against laws that are known without the code under test.
#include "cases/laboratory/experiment.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>
#include <utility>

#include "adapters/engines.h"
#include "cases/metrics/verdict.h"
#include "core/base/error.h"
#include "tests/scenes.h"

BOOST_AUTO_TEST_SUITE(cases_laboratory_experiment)

namespace {

using namespace rigor;
using namespace rigor::test;

constexpr double kDt = 1.0 / 32;  // a power of two: n dt is exact

// A body that falls freely from rest, and its closed form.
Scene falling() {
  Scene scene;
  scene.gravity = {0, -8, 0};
  scene.bodies = {body("stone", 2, {1, 1, 1}, {0, 10, 0})};
  return scene;
}

Case case_of(Scene scene, const std::string& truth, double duration) {
  Case made;
  made.id = "made", made.scene = std::move(scene), made.truth = truth, made.duration = duration;
  return made;
}

void run_to_end(Experiment& run) {
  while (run.step()) {
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(semi_implicit_euler_falls_g_dt_t_half_too_far) {
  const Case made = case_of(falling(), "projectile", 1);
  Experiment run(engines(), made.scene, "core:semi-implicit-euler", kDt, made.duration);
  run.compare_with(truth_table(made, true_motion(made), kDt));
  run_to_end(run);
  BOOST_TEST(run.readings() == 33u);
  for (std::size_t n = 0; n < run.readings(); ++n) {
    const double t = static_cast<double>(n) * kDt;
    BOOST_TEST(run.reading(n).time == t);
    BOOST_TEST(std::abs(run.reading(n).position_error - 0.5 * 8 * kDt * t) < 1e-13);  // roundings of 10 m
    BOOST_TEST(run.reading(n).orientation_error < 1e-15);
    // v²/2 + g y of x = -g t (t + dt)/2, v = -g t
    const double expected = 2 * (0.5 * 64 * t * t + 8 * (10 - 4 * t * (t + kDt)));
    BOOST_TEST(std::abs(run.reading(n).energy - expected) < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(a_truth_that_comes_late_gives_the_same_errors) {
  const Case made = case_of(falling(), "projectile", 1);
  Experiment early(engines(), made.scene, "core:explicit-euler", kDt, 1),
      late(engines(), made.scene, "core:explicit-euler", kDt, 1);
  early.compare_with(truth_table(made, true_motion(made), kDt));
  run_to_end(early), run_to_end(late);
  BOOST_TEST(std::isnan(late.reading(5).position_error));
  late.compare_with(truth_table(made, true_motion(made), kDt));
  for (std::size_t n = 0; n < early.readings(); ++n)
    BOOST_TEST(early.reading(n).position_error == late.reading(n).position_error);
  late.compare_with({.dt = kDt, .bodies = 1, .numbers = {}, .kind = ""});
  BOOST_TEST(std::isnan(late.reading(5).position_error));
}

BOOST_AUTO_TEST_CASE(an_added_matrix_stretches_by_its_law) {
  Scene scene;
  scene.bodies = {body("ball", 1, {1, 1, 1})};
  scene.bodies[0].angular_velocity = {0, 0, 2};
  Experiment run(engines(), scene, "core:semi-implicit-euler,orientation=matrix-additive", kDt, 2);
  run_to_end(run);
  for (std::size_t n = 0; n < run.readings(); ++n) {
    const double expected = std::sqrt(2.0) * (std::pow(1 + 4 * kDt * kDt, static_cast<double>(n)) - 1);
    BOOST_TEST(std::abs(run.reading(n).orthonormality - expected) < 1e-12);
  }
}

// A rod turns about its end with w, free of forces. ODE's first step moves its centre along the tangent by w r dt and
// turns it by w dt = a. The end leaves its place by r a²/2, but for terms of a³.
BOOST_AUTO_TEST_CASE(the_gap_of_a_joint_after_one_straight_step_is_known) {
  constexpr double kArm = 0.5, kSpin = 2, kTurn = kSpin * kDt;
  Scene scene;
  scene.bodies = {body("rod", 1, {1, 1, 1}, {kArm, 0, 0})};
  scene.bodies[0].velocity = {0, kSpin * kArm, 0}, scene.bodies[0].angular_velocity = {0, 0, kSpin};
  scene.joints.push_back({.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}});
  Experiment straight(engines(), scene, "core:ode-twin", kDt, 1),
      held(engines(), scene, "core:velocity-verlet", kDt, 1);
  BOOST_TEST(straight.reading(0).joint_gap < 1e-15);
  straight.step();
  BOOST_TEST(std::abs(straight.reading(1).joint_gap / (0.5 * kArm * kTurn * kTurn) - 1) < kTurn);
  run_to_end(held);
  double widest = 0;
  for (std::size_t n = 0; n < held.readings(); ++n) widest = std::max(widest, held.reading(n).joint_gap);
  BOOST_TEST(widest < 1e-12);
  const Experiment none(engines(), falling(), "core:ode-twin", kDt, 1);
  BOOST_TEST(std::isnan(none.reading(0).joint_gap));
}

// Overlaps of many bodies take seconds: a brief judgement has all but these, and a full one has them.
BOOST_AUTO_TEST_CASE(a_brief_judgement_leaves_out_the_overlaps_of_many) {
  Scene few, many;
  for (int i = 0; i < 60; ++i) {
    Body ball = body("ball " + std::to_string(i), 1, {1, 1, 1}, {3.0 * i, 0, 0});
    ball.shape = Sphere{0.5}, ball.collides = true;
    many.bodies.push_back(ball);
    if (i < 2) few.bodies.push_back(ball);
  }
  for (const auto& [scene, has_many] : {std::pair(few, false), {many, true}}) {
    Experiment run(engines(), scene, "core:semi-implicit-euler,contact=impulse", kDt, 1);
    run.step();
    const Cell brief = run.judge(true), full = run.judge();
    BOOST_TEST(full.metrics.contains("penetration"));
    BOOST_TEST(brief.metrics.contains("penetration") == !has_many);
    BOOST_TEST(brief.metrics.size() == full.metrics.size() - (has_many ? 1 : 0));
    BOOST_TEST((brief.stability.verdict == full.stability.verdict));
  }
}

BOOST_AUTO_TEST_CASE(a_run_that_explodes_is_judged_and_ends) {
  const Case made = case_of(fixed_spring(), "reference", 5);
  Experiment run(engines(), made.scene, "core:explicit-euler", 1.0 / 30, made.duration);
  run_to_end(run);
  const Cell cell = run.judge();
  BOOST_TEST((cell.stability.verdict == Verdict::blown_up));
  BOOST_TEST(cell.stability.time > 0.2);
  BOOST_TEST(cell.stability.time < 0.7);  // the case's gate: a thousandfold by 0.68 s
  BOOST_TEST((cell.status == Status::diverged));
}

BOOST_AUTO_TEST_CASE(the_stand_in_is_near_the_truth_and_says_what_it_is) {
  const Case made = case_of(fixed_spring(), "reference", 1);
  const TrueMotion motion = true_motion(made);
  BOOST_TEST(motion.kind == "reference");
  const TruthTable truth = truth_table(made, motion, kDt), stand_in = provisional_table(made, kDt);
  BOOST_TEST(stand_in.is_provisional);
  BOOST_TEST_REQUIRE(truth.numbers.size() == stand_in.numbers.size());
  for (std::size_t row = 0; row < truth.rows(); ++row) {
    for (std::size_t c = 0; c < 13; ++c)
      BOOST_TEST(std::abs(truth.numbers[14 * row + c] - stand_in.numbers[14 * row + c]) < 1e-9);  // tolerance 1e-12
    BOOST_TEST(std::isnan(stand_in.error(row)));
  }
}

BOOST_AUTO_TEST_CASE(a_changed_scene_gets_another_truth) {
  Scene scene = falling();
  scene.springs = {spring(kWorld, {0, 20, 0}, 0, {0, 0, 0}, 3, 4)};
  const TrueMotion motion = true_motion(case_of(scene, "projectile", 1));
  BOOST_TEST(motion.kind == "reference");
  Scene many;
  for (int i = 0; i < 40; ++i) many.bodies.push_back(body("b" + std::to_string(i), 1, {1, 1, 1}));
  const TrueMotion none = true_motion(case_of(many, "none", 1));
  BOOST_TEST(!none.truth);
  BOOST_TEST(none.why_none.find("40 bodies move") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(what_a_method_lacks_is_said) {
  Scene scene = fixed_spring();
  BOOST_CHECK_THROW(Experiment(engines(), scene, "core:rk5", kDt, 1), InputError);
  Joint joint{.a = kWorld, .b = 0, .type = BallJoint{{0, 0.5, 0}}};
  scene.joints.push_back(joint);
  BOOST_CHECK_THROW(Experiment(engines(), scene, "core:adams", kDt, 1), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
