#include "cases/metrics/measures/recorded/recorded_gaps.h"

#include <boost/test/unit_test.hpp>

#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_recorded_recorded_gaps)

namespace {

constexpr double kFloor = 1.5957691216057308;  // 2 sqrt(2/pi)

// At rest at the origin, recorded ten times a second, with a gap from 0.5 to 1.5 s.
std::shared_ptr<MotionRecording> rest(double position_noise, double orientation_noise) {
  auto made = std::make_shared<MotionRecording>();
  made->position_noise = position_noise, made->orientation_noise = orientation_noise, made->length = 0.5;
  RecordedBody body;
  for (const double t : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0}) {
    body.times.push_back(t);
    for (std::vector<Vec3>* part : {&body.positions, &body.velocities, &body.angular_velocities})
      part->push_back(Vec3::Zero());
    body.orientations.push_back(Quat::Identity());
  }
  made->trials = {{"one", {body}, 2}};
  return made;
}

// A run that is 3-4-5 off by 5 c t, and turned by t c about z.
Trajectory off_by(double c, double end) {
  Trajectory run{0.1, {}};
  for (int n = 0; 0.1 * n <= end + 1e-9; ++n) {
    const double t = 0.1 * n;
    Sample sample{t, KeptBodies(1)};
    sample.bodies.columns().set_body(
        0, {{3 * c * t, 0, 4 * c * t}, rotation_by(Vec3(0, 0, c * t)), Vec3::Zero(), Vec3::Zero()});
    run.samples.push_back(sample);
  }
  return run;
}

struct Measured {
  MetricResult position, rotation;
};

Measured measured(const Trajectory& run, double position_noise, double orientation_noise) {
  Scene scene;
  scene.bodies = {test::body("cube", 1, {1, 1, 1})};
  const RecordedMotion truth(rest(position_noise, orientation_noise), 0, scene);
  TruthSamples samples{{}, {}, 0, &truth};
  JudgedRun judged{scene, run, &samples, 0};
  judged.duration = 2;
  return {find_metric("mean_position_error")->measure(judged), find_metric("mean_rotation_error")->measure(judged)};
}

}  // namespace

// The samples from 0.1 to 0.5 s and from 1.5 to 2 s are compared: their mean time is (1.5 + 10.5)/11 s.
BOOST_AUTO_TEST_CASE(the_mean_leaves_out_the_start_and_the_gap) {
  const auto [position, rotation] = measured(off_by(0.01, 2), 1e-6, 1e-6);
  BOOST_TEST_REQUIRE(position.measurement.has_value());
  BOOST_TEST_REQUIRE(rotation.measurement.has_value());
  BOOST_TEST(std::abs(position.measurement->value - 100 * 0.05 * 12 / 11 / 0.5) < 1e-9);
  BOOST_TEST(std::abs(rotation.measurement->value - 0.01 * 12 / 11 * 180 / M_PI) < 1e-9);
  BOOST_TEST(std::abs(position.measurement->worst.time - 2) < 1e-9);
  BOOST_TEST(std::abs(position.measurement->worst.found - 100 * 0.1 / 0.5) < 1e-9);
  BOOST_TEST(position.measurement->series.size() == 11u);
}

BOOST_AUTO_TEST_CASE(a_run_closer_than_the_noise_has_the_error_of_the_noise) {
  const auto [position, rotation] = measured(off_by(1e-6, 2), 1e-3, 2e-3);
  BOOST_TEST(std::abs(position.measurement->value - 100 * kFloor * 1e-3 / 0.5) < 1e-12);
  BOOST_TEST(std::abs(rotation.measurement->value - kFloor * 2e-3 * 180 / M_PI) < 1e-12);
}

// A run that stops before it goes wrong must not look good.
BOOST_AUTO_TEST_CASE(a_run_that_ended_early_has_no_mean) {
  const auto [position, rotation] = measured(off_by(0.01, 1.7), 1e-3, 1e-3);
  BOOST_TEST(!position.measurement.has_value());
  BOOST_TEST(position.not_applicable.find("ended before the recording") != std::string::npos);
  BOOST_TEST(!rotation.measurement.has_value());
}

BOOST_AUTO_TEST_SUITE_END()
