// Metrics of bodies with equal errors, and of errors that a metric does not measure.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_ties)

namespace {

// Bodies at these places at 0, 1, 2, ... s; those that are not named stay where the scene has them.
Trajectory at_places(const Scene& scene, const std::vector<std::map<std::size_t, Vec3>>& places) {
  Trajectory run{1, {}};
  for (const auto& moved : places) {
    BodyTable table(scene.bodies.size());
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      table.columns().set_body(i, {scene.bodies[i].position, Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
    for (const auto& [body, place] : moved) table.columns().set_position(body, place);
    run.samples.push_back({static_cast<double>(run.samples.size()), table});
  }
  return run;
}

TruthSamples truth_of(const Trajectory& run) {
  TruthSamples truth;
  truth.largest_kinetic_energy = 1;
  for (const Sample& sample : run.samples) truth.bodies.push_back(sample.bodies), truth.error.push_back(0);
  return truth;
}

Measurement measured(const std::string& metric, const JudgedRun& run) {
  const MetricResult result = test::measured(metric, run);
  BOOST_TEST_REQUIRE(result.measurement.has_value(), metric << ": " << result.not_applicable);
  return *result.measurement;
}

Scene two_boxes() {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("one", Box{{1, 1, 1}}, 2, {0, 0, 0.5}),
                  test::on_its_own("other", Box{{1, 1, 1}}, 2, {5, 0, 0.5}), test::plane()};
  scene.contact_default = {0, 0.5};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(of_two_that_creep_or_sink_as_far_the_first_is_named) {
  const Scene scene = two_boxes();
  const Trajectory creeps = at_places(scene, {{}, {{0, {0, 0.25, 0.5}}, {1, {5, 0.25, 0.5}}}});
  BOOST_TEST(measured("creep", {scene, creeps, nullptr, 0}).worst.body == 0);
  const Trajectory sinks = at_places(scene, {{}, {{0, {0, 0, 0.25}}, {1, {5, 0, 0.25}}}});
  BOOST_TEST(measured("penetration", {scene, sinks, nullptr, 0}).worst.body == 0);
}

// A rotated body stays in place, and a body of equal speed may have another orientation.
BOOST_AUTO_TEST_CASE(a_turn_is_no_displacement_and_a_speed_no_turn) {
  Scene scene = two_boxes();
  scene.bodies = {scene.bodies[2], scene.bodies[0]};
  const Trajectory rest = at_places(scene, {{}, {}});
  const TruthSamples truth = truth_of(rest);
  const TwinRun twin{rest, {0, 0}, {0, 0}};
  const auto judged = [&](const Trajectory& run) { return JudgedRun{scene, run, &truth, 0, &twin}; };
  Trajectory turned = rest, fast = rest;
  for (const std::size_t body : {0, 1}) {
    turned.samples[1].bodies.columns().set_orientation(body, Quat(0, 1, 0, 0));
    fast.samples[1].bodies.columns().set_velocity(body, {3, 4, 5});
  }
  for (const char* metric : {"position_error", "unexplained_error", "creep", "velocity_error", "unexplained_velocity",
                             "orthonormality_error"})
    BOOST_TEST(measured(metric, judged(turned)).value == 0, metric);
  BOOST_TEST(measured("collapse_time", judged(turned)).worst.body == kWorld);
  for (const char* metric : {"position_error", "unexplained_error", "creep", "orientation_error",
                             "unexplained_rotation", "orthonormality_error", "unexplained_spin"})
    BOOST_TEST(measured(metric, judged(fast)).value == 0, metric);
}

// Three that should all slide as far: of those that are as far off as each other the first.
BOOST_AUTO_TEST_CASE(of_stops_as_far_off_the_first_is_named) {
  Scene scene = test::on_slope(Box{{0.4, 0.4, 0.2}}, 0, 0.5, 5);
  for (const double y : {3.0, 6.0}) {
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies.back().position.y() = y;
  }
  const auto truth = make_truth("sliding", scene, 3);
  Trajectory run = test::played(*truth, scene, 0.01, 300);
  const TruthSamples samples = test::sampled(*truth, run, scene, 25);
  const double stop = run.samples.back().bodies.columns().position(0).x();
  const auto worst_of = [&](double first, double second, double third) {
    const auto columns = run.samples.back().bodies.columns();
    columns.set_position(0, {first * stop, 0, 0.1}), columns.set_position(2, {second * stop, 3, 0.1});
    columns.set_position(3, {third * stop, 6, 0.1});
    return measured("friction_anisotropy", {scene, run, &samples, 0}).worst.body;
  };
  BOOST_TEST(worst_of(0.75, 0.75, 1) == 0);
  BOOST_TEST(worst_of(1, 0.75, 0.75) == 2);
  // The last of equally long ones, as with std::minmax_element.
  BOOST_TEST(worst_of(1.5, 1.5, 1) == 2);
}

// A pendulum's momentum is not its own.
BOOST_AUTO_TEST_CASE(a_joint_to_the_world_holds_from_outside) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  scene.bodies = {test::body("rod", 1, {0.001, 1.0 / 12, 1.0 / 12}, {0.5, 0, 0})};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}}};
  const Trajectory run = at_places(scene, {{}, {}});
  for (const char* metric : {"linear_momentum_drift", "angular_momentum_drift"})
    BOOST_TEST(test::measured(metric, {scene, run, nullptr, 0}).not_applicable ==
               "a joint holds 'world' to 'rod', and the case has no truth");
}

// A twin whose roundings are too large from the start on is held against nothing.
BOOST_AUTO_TEST_CASE(roundings_count_from_the_start_on) {
  Scene scene;
  scene.bodies = {test::body("b", 1, {1, 1, 1}, {1, 0, 0})};
  const Trajectory run = at_places(scene, {{}, {}, {}});
  const TwinRun twin{run, {1e-3, 0, 0}, {1e-3, 0, 0}};
  for (const char* metric : {"unexplained_error", "unexplained_rotation", "unexplained_velocity"})
    BOOST_TEST(!test::measured(metric, {scene, run, nullptr, 0, &twin}).measurement.has_value(), metric);
}

BOOST_AUTO_TEST_SUITE_END()
