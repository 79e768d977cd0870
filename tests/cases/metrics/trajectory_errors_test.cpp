// position_error, orientation_error and orthonormality_error, on trajectories made by hand with a known error.
#include <boost/test/unit_test.hpp>

#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_trajectory_errors)

namespace {

// Two bodies that the truth has at rest, sampled at 0, 1, 2, 3 s; the truth is good up to 2 s.
struct AtRest {
  Scene scene;
  Trajectory trajectory{1, {}};
  TruthSamples truth;

  AtRest() {
    scene.bodies = {test::body("a", 1, {1, 1, 1}, {1, 2, 3}), test::body("b", 1, {1, 1, 1})};
    truth.error = {0, 1e-9, 1e-7, 1e-3};
    truth.largest_kinetic_energy = 1;
    for (int n = 0; n < 4; ++n) {
      BodyTable bodies(2);
      for (int i = 0; i < 2; ++i) {
        bodies.columns().set_body(i, {scene.bodies[i].position, Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
      }
      trajectory.samples.push_back({static_cast<double>(n), bodies});
      truth.bodies.push_back(bodies);
    }
  }
  MutableBodyColumns at(int n) { return trajectory.samples[n].bodies.columns(); }
  JudgedRun run() const { return {scene, trajectory, &truth, 0}; }
};

}  // namespace

BOOST_AUTO_TEST_CASE(the_position_error_is_the_largest_distance_within_the_truths_horizon) {
  AtRest made;
  made.at(1).set_position(0, {1.3, 2, 3.4});
  made.at(2).set_position(1, {0.1, 0, 0});
  made.at(3).set_position(1, {100, 0, 0});  // beyond what the truth can vouch for
  const Measurement m = *test::measured("position_error", made.run()).measurement;
  BOOST_TEST(m.value == 0.5, boost::test_tools::tolerance(1e-14));  // 3-4-5
  BOOST_TEST(m.worst.time == 1);
  BOOST_TEST(m.worst.body == 0);
  BOOST_TEST(m.worst.component == "position.z");
  BOOST_TEST(m.worst.found == 3.4);
  BOOST_TEST(m.worst.expected == 3);
  BOOST_TEST(m.compared_until == 2);
  BOOST_REQUIRE(m.series.size() == 3);
  BOOST_TEST(m.series[2] == 0.1);
}

// At the start nothing is off, whatever the engine does: that is no error of 0.
BOOST_AUTO_TEST_CASE(a_truth_that_is_good_at_the_start_alone_measures_nothing) {
  AtRest made;
  made.truth.error = {0, 1e-3, 1e-3, 1e-3};
  made.at(1).set_position(0, {100, 0, 0});
  for (const char* name : {"position_error", "orientation_error", "velocity_error"}) {
    const MetricResult found = test::measured(name, made.run());
    BOOST_TEST(!found.measurement.has_value(), name);
    BOOST_TEST(found.not_applicable == "there is no sample after the start at which the truth is good enough");
  }
}

// A run that has no more than its start is compared there, for there is nothing else; one that has more is not.
BOOST_AUTO_TEST_CASE(a_run_that_is_its_start_alone_is_compared_there) {
  AtRest made;
  made.truth.error = {0, 1, 1, 1};
  for (const auto& [count, is_measured] : {std::pair{1, true}, {2, false}}) {
    AtRest shorter = made;
    shorter.trajectory.samples.resize(count);
    for (const char* name : {"position_error", "orientation_error"})
      BOOST_TEST(test::measured(name, shorter.run()).measurement.has_value() == is_measured, name);
  }
}

BOOST_AUTO_TEST_CASE(the_orientation_error_is_of_any_body) {
  for (const int body : {0, 1}) {
    AtRest made;
    made.at(1).set_orientation(body, rotation_by({0, 0, 0.25}));
    const Measurement m = *test::measured("orientation_error", made.run()).measurement;
    BOOST_TEST(m.value == 0.25, boost::test_tools::tolerance(1e-14));
    BOOST_TEST((m.worst.body == body && m.worst.time == 1));
  }
}

BOOST_AUTO_TEST_CASE(the_orientation_error_is_an_angle_whatever_the_quaternions_sign_and_length) {
  AtRest made;
  const Quat turned(Eigen::AngleAxisd(0.25, Vec3(1, 2, 2) / 3));
  made.at(1).set_orientation(1, Quat(-3 * turned.coeffs()));
  made.at(3).set_orientation(0, Quat(0, 1, 0, 0));
  const Measurement m = *test::measured("orientation_error", made.run()).measurement;
  BOOST_TEST(m.value == 0.25, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(m.worst.time == 1);
  BOOST_TEST(m.worst.body == 1);
  BOOST_TEST(m.compared_until == 2);
}

BOOST_AUTO_TEST_CASE(a_lost_quaternion_norm_shows_as_a_lost_orthonormality) {
  AtRest made;
  made.at(3).set_orientation(1, Quat(0.99, 0, 0, 0));
  const Measurement m = *test::measured("orthonormality_error", made.run()).measurement;
  // R = .99² I, so RᵀR - I = (.99⁴ - 1) I, and its norm that times sqrt 3.
  BOOST_TEST(m.value == (1 - std::pow(0.99, 4)) * std::sqrt(3), boost::test_tools::tolerance(1e-13));
  BOOST_TEST(m.worst.time == 3);
  BOOST_TEST(m.compared_until == 3);
}

BOOST_AUTO_TEST_CASE(an_engines_own_matrix_is_what_is_tested_where_it_keeps_one) {
  AtRest made;
  BodyTable bodies(2, true);
  for (int i = 0; i < 2; ++i) {
    bodies.columns().set_orientation(i, Quat::Identity());
    bodies.columns().set_rotation(i, Mat3::Identity());
  }
  Mat3 sheared = Mat3::Identity();
  sheared(0, 1) = 0.1;  // RᵀR - I has .1 twice and .01 once
  bodies.columns().set_rotation(0, sheared);
  made.trajectory.samples[2].bodies = bodies;
  const Measurement m = *test::measured("orthonormality_error", made.run()).measurement;
  BOOST_TEST(m.value == std::sqrt(2 * 0.01 + 1e-4), boost::test_tools::tolerance(1e-13));
  BOOST_TEST(m.worst.body == 0);
}

BOOST_AUTO_TEST_CASE(adding_the_matrixs_change_loses_orthonormality_as_it_must) {
  // R + dt [w] R: each step multiplies RᵀR across the axis by 1 + (w dt)².
  const Scene scene = test::thrown_cube();
  Settings settings = test::core_method("explicit-euler");
  settings.options["orientation"] = "matrix-additive";
  const Simulation run = simulate(find_engine(engines(), "core"), settings, scene, 1.0 / 30, 1);
  const Measurement m = *test::measured("orthonormality_error", {scene, run.trajectory, nullptr, 0}).measurement;
  BOOST_TEST(m.value == std::sqrt(2) * (std::pow(1 + 1.0 / 9, 30) - 1), boost::test_tools::tolerance(1e-10));
}

BOOST_AUTO_TEST_CASE(a_run_is_held_against_its_twin_until_roundings_alone_may_have_parted_them) {
  AtRest made;
  TwinRun twin{made.trajectory, {}, {}};
  JudgedRun run = made.run();
  run.twin = &twin;
  const auto compared_until = [&](const std::vector<double>& rounding) {
    twin.position_rounding = rounding;
    return test::measured("unexplained_error", run).measurement->compared_until;
  };
  // 1e-10 of how far from W's origin the twin has come, sqrt(14) m = 3.742 m; and never past the truth, good up to 2 s.
  BOOST_TEST(compared_until({0, 0, 0, 0}) == 2);
  run.truth = nullptr;
  BOOST_TEST(compared_until({0, 0, 0, 0}) == 3);
  BOOST_TEST(compared_until({0, 1e-10, 3.74e-10, 3.75e-10}) == 2);
  BOOST_TEST(compared_until({0, 3.75e-10, 3.75e-10, 3.75e-10}) == 0);
}

// Relative to one radian, exactly 1e-10.
BOOST_AUTO_TEST_CASE(orientations_are_held_against_the_twins_up_to_just_what_roundings_may_have_made) {
  AtRest made;
  const TwinRun twin{made.trajectory, {0, 0, 0, 0}, {0, 1e-10, 1e-10, 1.2e-10}};
  made.at(1).set_orientation(0, rotation_by({0, 0.25, 0}));
  made.at(3).set_orientation(1, rotation_by({0, 2, 0}));
  JudgedRun run = made.run();
  run.twin = &twin, run.truth = nullptr;
  const Measurement m = *test::measured("unexplained_rotation", run).measurement;
  BOOST_TEST(m.compared_until == 2);
  BOOST_TEST(m.value == 0.25, boost::test_tools::tolerance(1e-14));
  BOOST_TEST((m.worst.body == 0 && m.worst.time == 1));
}

BOOST_AUTO_TEST_CASE(without_a_truth_only_what_needs_none_is_measured) {
  AtRest made;
  const JudgedRun run{made.scene, made.trajectory, nullptr, 0};
  BOOST_TEST(test::measured("position_error", run).not_applicable == "the case has no truth");
  BOOST_TEST(test::measured("orientation_error", run).not_applicable == "the case has no truth");
  BOOST_TEST(test::measured("orthonormality_error", run).measurement->value == 0);
}

BOOST_AUTO_TEST_SUITE_END()
