// The joint metrics on runs with known gaps, and what the energy metrics know of joints.
#include <boost/test/unit_test.hpp>

#include "cases/metrics/measures/joints/joint_reactions.h"
#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_joint_metrics)

namespace {

// A rod of 1 m and 1 kg on a hinge about z at its end, let go level.
Scene pendulum() {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  scene.bodies = {test::body("rod", 1, {0.001, 1.0 / 12, 1.0 / 12}, {0.5, 0, 0})};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}}};
  return scene;
}

const char* const kOfJoints[] = {"joint_gap",        "joint_gap_rate", "joint_twist",
                                 "joint_twist_rate", "reaction_error", "reaction_torque_error"};

double value_of(const std::string& metric, const JudgedRun& run) {
  const MetricResult result = test::measured(metric, run);
  BOOST_TEST_CONTEXT(metric << ": " << result.not_applicable) BOOST_REQUIRE(result.measurement.has_value());
  return result.measurement->value;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_scene_without_joints_has_no_value) {
  const Scene scene = test::fixed_spring();
  Trajectory still{1, {{0, BodyTable(1)}}};
  for (const char* metric : kOfJoints)
    BOOST_TEST(test::measured(metric, {scene, still, nullptr, 0}).not_applicable == "the scene has no joints");
  for (const char* metric : {"reported_reaction_error", "reported_reaction_torque_error"})
    BOOST_TEST(test::measured(metric, {scene, still, nullptr, 0}).not_applicable == "the scene has no joints");
}

BOOST_AUTO_TEST_CASE(a_truth_holds_its_joints_and_carries_what_it_carries) {
  const Scene scene = pendulum();
  const auto truth = make_truth("reference", scene, 2);
  const Trajectory run = test::played(*truth, scene, 0.02, 100);
  const TruthSamples samples = test::sampled(*truth, run, scene, 5);
  for (const char* metric : kOfJoints)  // roundings of a metre, 5 m/s and 25 N
    BOOST_TEST_CONTEXT(metric) BOOST_TEST(value_of(metric, {scene, run, &samples, 0}) < 1e-13);
}

BOOST_AUTO_TEST_CASE(a_known_gap_is_found_at_its_time_and_joint) {
  Scene scene = pendulum();
  scene.bodies.push_back(test::body("lower", 1, {0.001, 1.0 / 12, 1.0 / 12}, {1.5, 0, 0}));
  scene.joints.push_back({.a = 0, .b = 1, .type = HingeJoint{{1, 0, 0}, Vec3::UnitZ()}});
  const auto truth = make_truth("reference", scene, 1);
  Trajectory run = test::played(*truth, scene, 0.1, 10);
  const MutableBodyColumns moved = run.samples[7].bodies.columns();
  moved.set_position(1, moved.position(1) + Vec3(0, 0.003, 0.004));
  moved.set_angular_velocity(1, moved.angular_velocity(1) + Vec3(0.02, 0, 5));  // 5 rad/s about its axis are free
  const Measurement gap = *test::measured("joint_gap", {scene, run, nullptr, 0}).measurement;
  BOOST_TEST(gap.value == 0.005, boost::test_tools::tolerance(1e-10));
  BOOST_TEST(gap.worst.time == run.samples[7].time);
  BOOST_TEST(gap.worst.body == 1);
  BOOST_TEST(gap.worst.component == "gap of the hinge of 'rod' and 'lower'");
  BOOST_TEST(gap.series.size() == 11);
  BOOST_TEST(value_of("joint_twist_rate", {scene, run, nullptr, 0}) == 0.02, boost::test_tools::tolerance(1e-10));
}

BOOST_AUTO_TEST_CASE(no_joint_holds_an_angle_no_twist) {
  Scene scene = pendulum();
  scene.joints[0].type = BallJoint{Vec3::Zero()};
  Trajectory still{1, {{0, BodyTable(1)}}};
  for (const char* metric :
       {"joint_twist", "joint_twist_rate", "reaction_torque_error", "reported_reaction_torque_error"})
    BOOST_TEST(test::measured(metric, {scene, still, nullptr, 0}).not_applicable ==
               "no joint of the scene holds an angle");
  scene.joints.push_back(pendulum().joints[0]);  // one that does is enough
  BOOST_TEST(value_of("joint_twist", {scene, still, nullptr, 0}) == 0);
}

// A tenth faster, the hinge carries m d w² ((1.1)² - 1) more towards it.
BOOST_AUTO_TEST_CASE(a_known_speed_is_a_known_reaction) {
  const Scene scene = pendulum();
  const auto truth = make_truth("reference", scene, 1);
  Trajectory run = test::played(*truth, scene, 0.01, 100);
  const TruthSamples samples = test::sampled(*truth, run, scene, 5);
  const MutableBodyColumns faster = run.samples[50].bodies.columns();
  const double w = faster.angular_velocity(0).z();
  faster.set_velocity(0, 1.1 * faster.velocity(0)), faster.set_angular_velocity(0, 1.1 * faster.angular_velocity(0));
  const Measurement found = *test::measured("reaction_error", {scene, run, &samples, 0}).measurement;
  BOOST_TEST(found.value == 0.5 * w * w * 0.21, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(found.worst.time == run.samples[50].time);
  BOOST_TEST(found.worst.component == "force of the hinge of 'world' and 'rod'");
  BOOST_TEST(found.worst.body == 0);
  BOOST_TEST(found.series.empty());  // a hundred instants at most, and not the run's samples
  const MutableBodyColumns start = run.samples[0].bodies.columns();
  start.set_angular_velocity(0, {0, 0, 9}), start.set_velocity(0, {0, 4.5, 0});
  BOOST_TEST(test::measured("reaction_error", {scene, run, &samples, 0}).measurement->worst.time == 0);
}

BOOST_AUTO_TEST_CASE(a_truth_that_is_good_at_the_start_alone_measures_nothing_of_joints) {
  const Scene scene = pendulum();
  const auto truth = make_truth("reference", scene, 1);
  const Trajectory run = test::played(*truth, scene, 0.01, 100);
  TruthSamples samples = test::sampled(*truth, run, scene, 5);
  for (std::size_t n = 1; n < samples.error.size(); ++n) samples.error[n] = 1;
  for (const char* metric : {"reaction_error", "reaction_torque_error", "phase_error", "tube"}) {
    const MetricResult found = test::measured(metric, {scene, run, &samples, 0});
    BOOST_TEST(found.not_applicable == "there is no sample after the start at which the truth is good enough", metric);
  }
}

// A report of the truth's own mean over each step has no error, and one that is a tenth too large has that tenth.
BOOST_AUTO_TEST_CASE(a_report_is_held_against_the_mean_over_its_step) {
  const Scene scene = pendulum();
  const auto truth = make_truth("reference", scene, 1);
  Trajectory run = test::played(*truth, scene, 0.01, 100);
  const TruthSamples samples = test::sampled(*truth, run, scene, 5);
  // Anew after each change, for it keeps what it knows.
  const auto judged = [&] { return JudgedRun{scene, run, &samples, 0}; };
  for (const char* metric : {"reported_reaction_error", "reported_reaction_torque_error"})
    BOOST_TEST(test::measured(metric, judged()).not_applicable == "the engine does not say what joints carry");
  JointReactions reactions(scene);
  for (std::size_t n = 1; n < run.samples.size(); ++n) {
    const BodyColumns start = run.samples[n - 1].bodies.columns(), end = run.samples[n].bodies.columns();
    const JointReaction first = (*reactions.at(start, 0))[0], last = (*reactions.at(end, 0))[0];
    const Vec3 force = 0.5 * (first.force + last.force), couple = 0.5 * (first.couple + last.couple);
    run.samples[n].reactions = {{0, force, couple - start.position(0).cross(force)}};
  }
  BOOST_TEST(value_of("reported_reaction_error", judged()) < 1e-12);
  BOOST_TEST(value_of("reported_reaction_torque_error", judged()) < 1e-12);
  ReportedReaction& spoilt = run.samples[60].reactions[0];
  const Vec3 more = 0.1 * spoilt.force;
  spoilt.force += more, spoilt.torque -= run.samples[59].bodies.columns().position(0).cross(more);
  const Measurement found = *test::measured("reported_reaction_error", judged()).measurement;
  BOOST_TEST(found.value == more.norm(), boost::test_tools::tolerance(1e-9));
  BOOST_TEST(found.worst.time == run.samples[60].time);
  BOOST_TEST(found.series.empty());
  BOOST_TEST(found.worst.body == 0);
  BOOST_TEST(found.worst.component == "reported force of the hinge of 'world' and 'rod'");
  BOOST_TEST(value_of("reported_reaction_torque_error", judged()) < 1e-12);
  spoilt.torque += Vec3(0.3, 0, 0);
  BOOST_TEST(value_of("reported_reaction_torque_error", judged()) == 0.3, boost::test_tools::tolerance(1e-9));
  Trajectory thinned{run.dt, {}};
  for (std::size_t n = 0; n < run.samples.size(); n += 2) thinned.samples.push_back(run.samples[n]);
  const TruthSamples at_those = test::sampled(*truth, thinned, scene, 5);
  BOOST_TEST(test::measured("reported_reaction_error", {scene, thinned, &at_those, 0}).not_applicable ==
             "steps are not recorded one by one");
}

// Of a joint whose second end is the world's the report is on its first body, and as much the other way.
BOOST_AUTO_TEST_CASE(a_report_may_be_on_either_body_and_counts_as_far_as_the_truth_is_good) {
  Scene scene = pendulum();
  std::swap(scene.joints[0].a, scene.joints[0].b);
  const auto truth = make_truth("reference", scene, 1);
  Trajectory run = test::played(*truth, scene, 0.01, 100);
  TruthSamples samples = test::sampled(*truth, run, scene, 5);
  JointReactions reactions(scene);
  for (std::size_t n = 1; n < run.samples.size(); ++n) {
    const BodyColumns start = run.samples[n - 1].bodies.columns(), end = run.samples[n].bodies.columns();
    const JointReaction first = (*reactions.at(start, 0))[0], last = (*reactions.at(end, 0))[0];
    const Vec3 on_rod = -0.5 * (first.force + last.force), couple = -0.5 * (first.couple + last.couple);
    run.samples[n].reactions = {{0, on_rod, couple - start.position(0).cross(on_rod)}};
  }
  for (std::size_t n = 51; n < samples.error.size(); ++n) samples.error[n] = 1;
  run.samples[51].reactions[0].force += Vec3(1, 2, 3);
  const auto value = [&](const std::string& metric) { return value_of(metric, {scene, run, &samples, 0}); };
  BOOST_TEST(value("reported_reaction_error") < 1e-12);
  BOOST_TEST(value("reported_reaction_torque_error") < 1e-12);
  run.samples[50].reactions[0].force += Vec3(0, 0, 0.5);
  BOOST_TEST(value("reported_reaction_error") == 0.5, boost::test_tools::tolerance(1e-9));
  // The first step says nothing of a scheme, and two samples are no more than that.
  run.samples.resize(2), samples.bodies.resize(2), samples.error.resize(2);
  BOOST_TEST(test::measured("reported_reaction_error", {scene, run, &samples, 0}).not_applicable ==
             "there is no sample after the start at which the truth is good enough");
  run.samples.resize(1);
  BOOST_TEST(test::measured("reported_reaction_error", {scene, run, &samples, 0}).not_applicable ==
             "the engine does not say what joints carry");
}

BOOST_AUTO_TEST_CASE(what_the_equations_do_not_tell_has_no_reaction_error) {
  const auto why = [](void (*spoil)(Scene&)) {
    Scene scene = pendulum();
    const auto truth = make_truth("reference", scene, 0.2);
    spoil(scene);
    Trajectory run = test::played(*truth, pendulum(), 0.1, 2);
    const TruthSamples samples = test::sampled(*truth, run, pendulum(), 5);
    return test::measured("reaction_error", {scene, run, &samples, 0}).not_applicable;
  };
  BOOST_TEST(why([](Scene& s) { s.joints[0].upper = 1; }).find("a joint has limits") == 0);
  BOOST_TEST(why([](Scene& s) { s.motors = {{.joint = 0, .speed = 1, .most = 2}}; }).find("a motor keeps") == 0);
  BOOST_TEST(why([](Scene& s) { s.joints.push_back(s.joints[0]); }) ==
             "the equations of motion leave no joint's force unique");
  const Scene scene = pendulum();
  Trajectory still{1, {{0, BodyTable(1)}}};
  BOOST_TEST(test::measured("reaction_error", {scene, still, nullptr, 0}).not_applicable == "the case has no truth");
}

// A slider on a spring: without its spring's energy the run would seem to lose half of k x².
BOOST_AUTO_TEST_CASE(energy_knows_a_joints_spring_and_what_its_damper_takes) {
  Scene scene;
  scene.bodies = {test::body("mass", 2, {1, 1, 1})};
  scene.joints = {{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}, .stiffness = 50, .rest = 0.8}};
  const double stored = 0.5 * 50 * 0.8 * 0.8;  // J
  auto truth = make_truth("reference", scene, 5);
  const Trajectory kept = test::played(*truth, scene, 0.05, 100);
  BOOST_TEST(value_of("energy_drift",
                      {.scene = scene, .trajectory = kept, .truth = nullptr, .leapfrog_stagger = 0, .duration = 5}) <
             1e-12);
  scene.joints[0].damping = 3;
  truth = make_truth("reference", scene, 5);
  Trajectory damped = test::played(*truth, scene, 0.05, 100);
  const TruthSamples samples = test::sampled(*truth, damped, scene, stored);
  const JudgedRun alone{.scene = scene, .trajectory = damped, .truth = nullptr, .leapfrog_stagger = 0, .duration = 5};
  BOOST_TEST(value_of("energy_drift", alone) < 1e-12);                         // a loss is a damper's
  BOOST_TEST(value_of("energy_drift", {scene, damped, &samples, 0}) < 1e-12);  // and this much of it
  // A run that keeps what the damper should have taken is found out by the truth.
  const JudgedRun undamped{scene, kept, &samples, 0};
  BOOST_TEST(value_of("energy_drift", undamped) > 0.9);
}

// A motor's constant torque does work by the angle: E = tau theta; and nothing is expected of it without a truth.
BOOST_AUTO_TEST_CASE(energy_knows_what_a_motor_gives) {
  Scene scene = pendulum();
  scene.gravity.setZero();
  scene.motors = {{.joint = 0, .effort = 0.4, .speed = {}}};
  const auto truth = make_truth("reference", scene, 2);
  const Trajectory run = test::played(*truth, scene, 0.1, 20);
  const double about_hinge = 1.0 / 12 + 0.25, angle = 0.4 / about_hinge * 2 * 2 / 2;
  const TruthSamples samples = test::sampled(*truth, run, scene, 0.4 * angle);
  const Measurement drift = *test::measured("energy_drift", {scene, run, &samples, 0}).measurement;
  BOOST_TEST(drift.value < 1e-12);
  const BodyColumns end = run.samples.back().bodies.columns();
  const double kinetic = 0.5 * about_hinge * end.angular_velocity(0).squaredNorm();
  BOOST_TEST(kinetic == 0.4 * angle, boost::test_tools::tolerance(1e-12));
  Trajectory slower = run;
  for (Sample& sample : slower.samples) {
    const MutableBodyColumns bodies = sample.bodies.columns();
    bodies.set_velocity(0, 0.9 * bodies.velocity(0)), bodies.set_angular_velocity(0, 0.9 * bodies.angular_velocity(0));
  }
  BOOST_TEST(value_of("energy_drift", {scene, slower, &samples, 0}) == 0.19, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(test::measured("energy_drift", {scene, run, nullptr, 0}).not_applicable.find("forces or motors") == 0);
}

// The velocity of a semi-implicit step lies half a step before the position, and along the path as it was there. With
// gravity alone it would be brought off the path, by g dt/2 at the bottom; brought on to it, what is left is of second
// order: a fourth at half the step.
BOOST_AUTO_TEST_CASE(synchronised_velocities_keep_to_the_joints) {
  const Scene scene = pendulum();
  double before = 0;
  for (const double dt : {1.0 / 60, 1.0 / 120, 1.0 / 240}) {
    const Trajectory run =
        simulate(find_engine(engines(), "core"), test::core_method("semi-implicit-euler"), scene, dt, 4).trajectory;
    const JudgedRun judged{.scene = scene, .trajectory = run, .truth = nullptr, .leapfrog_stagger = 0.5, .duration = 4};
    const double drift = value_of("energy_drift_synchronised", judged), raw = value_of("energy_drift", judged);
    BOOST_TEST(drift < 0.2 * raw);
    if (before > 0) BOOST_TEST(before / drift > 3.5);
    before = drift;
  }
}

BOOST_AUTO_TEST_SUITE_END()
