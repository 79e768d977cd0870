#include <boost/test/unit_test.hpp>

#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_momentum_drift)

namespace {

Scene two_bodies_and_a_spring() {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {test::body("a", 1, {0.1, 0.2, 0.3}, {1, 0, 0}), test::body("b", 3, {0.2, 0.2, 0.3}, {-1, 0, 0})};
  scene.bodies[0].velocity = {0, 2, 0}, scene.bodies[1].angular_velocity = {1, 2, 3};
  scene.springs = {test::spring(0, {0.1, 0, 0.1}, 1, {0, 0.1, 0}, 50, 1, 2)};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_law_holds_for_the_reference_of_bodies_that_nothing_holds) {
  Scene scene = two_bodies_and_a_spring();
  TimedForce force;
  force.body = 1, force.torque = {0.3, 0.2, 0.1}, force.from = 0.55, force.until = 1.25;
  scene.forces = {force};
  const auto truth = make_truth("reference", scene, 3);
  const Trajectory run = test::played(*truth, scene, 0.1, 30);
  for (const char* metric : {"linear_momentum_drift", "angular_momentum_drift"}) {
    // No truth is given: gravity's and the torque's impulses are known. Roundings of up to 120 kg m/s over 30 m.
    BOOST_TEST_CONTEXT(metric) BOOST_TEST(test::measured(metric, {scene, run, nullptr, 0}).measurement->value < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(a_known_kick_is_a_known_drift) {
  const Scene scene = two_bodies_and_a_spring();
  const auto truth = make_truth("reference", scene, 1);
  Trajectory run = test::played(*truth, scene, 0.1, 10);
  const MutableBodyColumns kicked = run.samples[7].bodies.columns();
  kicked.set_velocity(1, kicked.velocity(1) + Vec3(0, 0.04, -0.03));
  const Measurement P = *test::measured("linear_momentum_drift", {scene, run, nullptr, 0}).measurement;
  BOOST_TEST(P.value == 3 * 0.05, boost::test_tools::tolerance(1e-10));
  BOOST_TEST(P.worst.time == run.samples[7].time);
  BOOST_TEST(P.worst.component == "P.y");
  BOOST_TEST(P.worst.found - P.worst.expected == 0.12, boost::test_tools::tolerance(1e-10));
  // b lies a quarter of the way from the centre of mass to a, on the other side: its arm is a quarter of b - a.
  const Vec3 arm = (kicked.position(1) - kicked.position(0)) / 4;
  const Measurement L = *test::measured("angular_momentum_drift", {scene, run, nullptr, 0}).measurement;
  BOOST_TEST(L.value == (3 * arm.cross(Vec3(0, 0.04, -0.03))).norm(), boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(bodies_held_from_outside_need_a_truth) {
  struct Row {
    Scene scene;
    const char* says;
  };
  Scene on_anchor = two_bodies_and_a_spring();
  on_anchor.bodies[1].fixed = true;
  for (const Row& row : {Row{test::fixed_spring(), "a spring holds 'world' to 'cube'"},
                         {test::dropped_sphere(1), "'ball' may touch 'ground'"},
                         {on_anchor, "a spring holds 'a' to 'b'"}}) {
    Trajectory still{1, {}};
    BodyTable bodies(row.scene.bodies.size());
    still.samples.push_back({0, bodies});
    for (const char* metric : {"linear_momentum_drift", "angular_momentum_drift"}) {
      const MetricResult result = test::measured(metric, {row.scene, still, nullptr, 0});
      BOOST_TEST(!result.measurement.has_value());
      BOOST_TEST_CONTEXT(result.not_applicable) BOOST_TEST(result.not_applicable.find(row.says) == 0);
    }
  }
}

BOOST_AUTO_TEST_CASE(held_bodies_are_compared_with_the_truth_up_to_its_horizon) {
  const Scene scene = test::fixed_spring();
  const auto truth = make_truth("reference", scene, 1);
  Trajectory run = test::played(*truth, scene, 0.1, 10);
  TruthSamples samples = test::sampled(*truth, run, scene, 100);
  run.samples[4].bodies.columns().set_velocity(0, run.samples[4].bodies.columns().velocity(0) + Vec3(0.5, 0, 0));
  run.samples[9].bodies.columns().set_velocity(0, Vec3(99, 0, 0));
  for (std::size_t n = 8; n < samples.error.size(); ++n) samples.error[n] = 1;
  const Measurement P = *test::measured("linear_momentum_drift", {scene, run, &samples, 0}).measurement;
  BOOST_TEST(P.value == 50, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(P.series.size() == 8);
}

BOOST_AUTO_TEST_CASE(a_force_off_the_only_bodys_centre_has_an_arm_that_only_the_truth_knows) {
  Scene scene;
  scene.bodies = {test::body("a", 1, {1, 1, 1})};
  TimedForce force;
  force.body = 0, force.force = {1, 0, 0};
  scene.forces = {force};
  Trajectory still{1, {}};
  still.samples.push_back({0, BodyTable(1)});
  BOOST_TEST(test::measured("angular_momentum_drift", {scene, still, nullptr, 0}).measurement.has_value());
  scene.forces[0].point = {0, 1, 0};
  BOOST_TEST(!test::measured("angular_momentum_drift", {scene, still, nullptr, 0}).measurement.has_value());
  BOOST_TEST(test::measured("linear_momentum_drift", {scene, still, nullptr, 0}).measurement.has_value());
}

BOOST_AUTO_TEST_SUITE_END()
