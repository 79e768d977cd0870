// The metrics of contact forces on reports whose errors are put there on purpose.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "cases/metrics/measures/contact/pair_forces.h"
#include "core/dynamics/model/system.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

namespace {

constexpr double kDt = 0.01, kWeight = 20;  // s, N
constexpr int kBall = 0, kGround = 1;

Scene ball_on_ground(double friction) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("ball", Sphere{0.5}, 2, {0, 0, 0.5}), test::plane()};
  scene.contact_default = {0, friction};
  return scene;
}

// The scene stands still, and each step reports what `report` says of it.
Trajectory standing(const Scene& scene, int steps, const std::function<std::vector<ReportedContact>(int)>& report) {
  Trajectory run{kDt, {}, true};
  BodyTable table(scene.bodies.size());
  set_initial_state(scene, table.columns());
  for (int n = 0; n <= steps; ++n)
    run.samples.push_back(
        {n * kDt, KeptBodies(std::as_const(table).columns()), {}, n > 0 ? report(n) : std::vector<ReportedContact>()});
  return run;
}

ReportedContact under_ball(const Vec3& force) { return {kGround, kBall, Vec3::Zero(), Vec3::UnitZ(), 0, force}; }

TruthSamples same_as(const Trajectory& run) {
  TruthSamples truth;
  for (const Sample& sample : run.samples) truth.bodies.push_back(sample.bodies);
  truth.error.assign(run.samples.size(), 0.0);
  truth.largest_kinetic_energy = 1;
  return truth;
}

MetricResult result_of(const std::string& metric, const Scene& scene, const Trajectory& run) {
  const TruthSamples truth = same_as(run);
  return test::measured(metric, {scene, run, &truth, 0});
}

double value_of(const std::string& metric, const Scene& scene, const Trajectory& run) {
  const MetricResult result = result_of(metric, scene, run);
  BOOST_TEST_REQUIRE(result.measurement.has_value(), metric << ": " << result.not_applicable);
  return result.measurement->value;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cases_metrics_contact_force_metrics)

BOOST_AUTO_TEST_CASE(a_weight_that_is_carried_leaves_nothing) {
  const Scene scene = ball_on_ground(0.5);
  const Trajectory run = standing(scene, 10, [](int) { return std::vector{under_ball({0, 0, kWeight})}; });
  for (const char* metric : {"contact_balance", "contact_force_error", "coulomb_residual", "force_ripple"})
    BOOST_TEST(value_of(metric, scene, run) < 1e-12, metric);
  BOOST_TEST(std::abs(value_of("force_peak", scene, run) - 1) < 1e-12);
}

BOOST_AUTO_TEST_CASE(a_force_that_is_wrong_is_seen_with_its_size_pair_and_instant) {
  const Scene scene = ball_on_ground(0.5);
  const Trajectory run = standing(scene, 10, [](int n) {
    return std::vector{under_ball({n == 7 ? 3.0 : 0.0, 0, n == 7 ? kWeight + 4 : kWeight})};
  });
  for (const char* metric : {"contact_balance", "contact_force_error"}) {
    const MetricResult result = result_of(metric, scene, run);
    BOOST_TEST_CONTEXT(metric) {
      BOOST_TEST(std::abs(result.measurement->value - 5) < 1e-12);  // a triangle of 3, 4, 5
      BOOST_TEST(result.measurement->worst.time == 7 * kDt);
      BOOST_TEST(result.measurement->worst.body == kBall);
      BOOST_TEST(std::abs(result.measurement->worst.expected - kWeight) < 1e-12);
    }
  }
  BOOST_TEST(std::abs(value_of("force_peak", scene, run) - std::hypot(3, 24) / kWeight) < 1e-12);
}

BOOST_AUTO_TEST_CASE(no_contact_where_one_must_carry_is_an_error_of_the_whole_weight) {
  const Scene scene = ball_on_ground(0.5);
  const Trajectory run = standing(scene, 10, [](int) { return std::vector<ReportedContact>(); });
  BOOST_TEST(std::abs(value_of("contact_force_error", scene, run) - kWeight) < 1e-12);
  BOOST_TEST(std::abs(value_of("contact_balance", scene, run) - kWeight) < 1e-12);
  BOOST_TEST(value_of("force_ripple", scene, run) == 1);
}

BOOST_AUTO_TEST_CASE(friction_beyond_the_cone_and_a_pull_are_outside_it) {
  const Scene scene = ball_on_ground(0.25);
  const auto residual = [&](const Vec3& force) {
    const Trajectory run = standing(scene, 3, [=](int) { return std::vector{under_ball(force)}; });
    return value_of("coulomb_residual", scene, run);
  };
  BOOST_TEST(residual({3, 4, 20}) == 0);  // at its limit
  BOOST_TEST(std::abs(residual({3, 4, 12}) - 2) < 1e-12);
  BOOST_TEST(std::abs(residual({0, 0, -6}) - 6) < 1e-12);
}

// 19 and 21 N in turn: a mean of 20 N, and a deviation of 1 N.
BOOST_AUTO_TEST_CASE(ripple_is_the_deviation_over_the_mean_of_the_second_half) {
  const Scene scene = ball_on_ground(0.5);
  const Trajectory run = standing(scene, 39, [](int n) {
    return std::vector{under_ball({0, 0, n < 20 ? 500 : kWeight + (n % 2 ? 1 : -1)})};
  });
  BOOST_TEST(std::abs(value_of("force_ripple", scene, run) - 0.05) < 1e-12);
  BOOST_TEST(std::abs(value_of("force_peak", scene, run) - 25) < 1e-12);
}

BOOST_AUTO_TEST_CASE(the_sums_on_bodies_give_the_forces_of_a_tree_and_not_those_of_a_loop) {
  const Vec3 up = Vec3::UnitZ();
  // A stack of three, the lowest last, with weights of 1, 2 and 4 N.
  const std::vector<Vec3> sums = {1 * up, 2 * up, 4 * up};
  const auto stack = pair_forces_of({{0, 1}, {1, 2}, {kWorld, 2}}, sums);
  BOOST_TEST_REQUIRE(stack.has_value());
  BOOST_TEST((stack->at({0, 1}) + up).norm() == 0);  // the second is pressed down with 1 N
  BOOST_TEST((stack->at({1, 2}) + 3 * up).norm() == 0);
  BOOST_TEST((stack->at({kWorld, 2}) - 7 * up).norm() == 0);
  BOOST_TEST(!pair_forces_of({{0, 1}, {kWorld, 0}, {kWorld, 1}}, sums).has_value());
  BOOST_TEST(pair_forces_of({}, sums)->empty());
}

BOOST_AUTO_TEST_CASE(forces_on_bodies_are_what_loads_do_not_explain) {
  Scene scene = ball_on_ground(0.5);
  scene.forces = {{.body = kBall, .force = Vec3(6, 0, 0), .from = 0, .until = 0.5}};
  BodyTable before(2), after(2);
  set_initial_state(scene, before.columns());
  set_initial_state(scene, after.columns());
  after.columns().set_velocity(kBall, {2, 0, 0});
  // 2 kg gain 2 m/s within 1 s. The force acts for half of it with 6 N, so contact gives 4 - 3 N, and bears the weight.
  const auto forces = forces_on_bodies(scene, std::as_const(before).columns(), std::as_const(after).columns(), 0, 1);
  BOOST_TEST((forces[kBall] - Vec3(1, 0, kWeight)).norm() < 1e-12);
  BOOST_TEST(forces[kGround].norm() == 0);
}

BOOST_AUTO_TEST_CASE(a_run_without_reports_says_so) {
  const Scene scene = ball_on_ground(0.5);
  Trajectory run = standing(scene, 3, [](int) { return std::vector<ReportedContact>(); });
  run.has_contacts = false;
  BOOST_TEST(result_of("contact_balance", scene, run).not_applicable == "the engine does not report contact forces");
}

BOOST_AUTO_TEST_SUITE_END()
