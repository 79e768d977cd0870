#include "cases/truth/recorded/recorded_motion.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_recorded_recorded_motion)

namespace {

constexpr double kNoise = 1e-3, kTurnNoise = 2e-3;

// A path that is a cubic of time, so that Hermite's cubic meets it exactly, and an even turn.
Vec3 path(double t) { return {1 + t, 2 * t * t, 3 - t * t * t}; }
Vec3 velocity(double t) { return {1, 4 * t, -3 * t * t}; }
const Vec3 kSpin(0.4, -1.2, 0.9);
Quat turn(double t) { return rotation_by(t * kSpin); }

std::shared_ptr<MotionRecording> recording(const std::vector<double>& times, bool with_rates = true) {
  auto made = std::make_shared<MotionRecording>();
  made->position_noise = kNoise, made->orientation_noise = kTurnNoise;
  RecordedBody body;
  body.body = 1;
  for (const double t : times) {
    body.times.push_back(t), body.positions.push_back(path(t)), body.orientations.push_back(turn(t));
    if (with_rates) body.velocities.push_back(velocity(t)), body.angular_velocities.push_back(kSpin);
  }
  made->trials = {{"one", {body}, times.back()}};
  return made;
}

Scene scene() {
  Scene scene;
  scene.bodies = {test::body("other", 1, {1, 1, 1}, {7, 8, 9}), test::body("cube", 1, {1, 1, 1})};
  return scene;
}

BodyState at(const RecordedMotion& truth, double t, std::size_t body = 1) {
  BodyTable table(2);
  truth.at(t, table.columns());
  return table.columns().body(body);
}

const std::vector<double> kTimes = {0, 0.1, 0.25, 0.3, 0.5};

}  // namespace

BOOST_AUTO_TEST_CASE(meets_a_cubic_and_an_even_turn_between_samples) {
  const RecordedMotion truth(recording(kTimes), 0, scene());
  for (double t = 0; t <= 0.5; t += 0.013) {
    const BodyState found = at(truth, t);
    BOOST_TEST((found.position - path(t)).norm() < 1e-14);
    BOOST_TEST((found.velocity - velocity(t)).norm() < 1e-13);
    BOOST_TEST(angle_between(found.orientation, turn(t)) < 1e-14);
    BOOST_TEST((found.angular_velocity - kSpin).norm() < 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(bodies_that_were_not_recorded_stay_where_the_scene_has_them) {
  const RecordedMotion truth(recording(kTimes), 0, scene());
  BOOST_TEST((at(truth, 0.2, 0).position == Vec3(7, 8, 9)));
}

BOOST_AUTO_TEST_CASE(without_rates_the_samples_give_them) {
  const RecordedMotion truth(recording(kTimes, false), 0, scene());
  for (const double t : kTimes) {
    BOOST_TEST((at(truth, t).position - path(t)).norm() < 1e-14);
    BOOST_TEST(angle_between(at(truth, t).orientation, turn(t)) < 1e-14);
  }
  // A parabola through three samples has the slope of a parabola exactly: y is one.
  BOOST_TEST(std::abs(at(truth, 0.25).velocity.y() - 4 * 0.25) < 1e-13);
  BOOST_TEST((at(truth, 0.25).angular_velocity - kSpin).norm() < 1e-13);
}

BOOST_AUTO_TEST_CASE(the_error_is_never_less_than_the_noise_and_never_falls) {
  const RecordedMotion truth(recording(kTimes), 0, scene());
  double before = 0;
  for (double t = 0; t <= 0.5; t += 0.01) {
    BOOST_TEST(truth.error(t) >= kTurnNoise);
    BOOST_TEST(truth.error(t) >= before);
    before = truth.error(t);
  }
  BOOST_TEST(truth.error(0) == kTurnNoise);
  BOOST_TEST(std::isinf(truth.error(0.51)));
}

// A ball that bounces between two samples: the cubic cannot know when.
BOOST_AUTO_TEST_CASE(the_error_covers_an_impact_between_two_samples) {
  auto made = recording({0, 1});
  RecordedBody& body = made->trials[0].bodies[0];
  body.velocities = {{0, 0, -2}, {0, 0, 1}};
  for (const double impact : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    const auto height = [&](double t) { return t < impact ? 2 * (impact - t) : t - impact; };
    body.positions = {{0, 0, height(0)}, {0, 0, height(1)}};
    const RecordedMotion truth(made, 0, scene());
    for (double t = 0.01; t < 1; t += 0.01)
      BOOST_TEST(std::abs(at(truth, t).position.z() - height(t)) <= truth.error(t));
  }
}

BOOST_AUTO_TEST_CASE(in_a_gap_nothing_was_measured_except_at_its_ends) {
  auto made = recording({0, 0.1, 0.2, 0.3, 1.0, 1.1, 1.2});
  const RecordedMotion truth(made, 0, scene());
  const RecordedBody& body = truth.trial().bodies[0];
  BOOST_TEST(truth.is_measured(body, 0.25));
  BOOST_TEST(truth.is_measured(body, 0.3));
  BOOST_TEST(!truth.is_measured(body, 0.5));
  BOOST_TEST(truth.is_measured(body, 1.0));
  BOOST_TEST(truth.is_measured(body, 1.2));
  BOOST_TEST(!truth.is_measured(body, 1.25));
}

// The mean length of a vector of three independent normal numbers, by another way: the sum over many drawn ones.
BOOST_AUTO_TEST_CASE(the_mean_of_noise_is_that_of_drawn_vectors) {
  unsigned long state = 1;
  const auto uniform = [&] {
    return static_cast<double>((state = state * 6364136223846793005UL + 1442695040888963407UL) >> 11) * 0x1p-53;
  };
  const auto normal = [&] { return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * M_PI * uniform()); };
  double sum = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) sum += Vec3(normal(), normal(), normal()).norm();
  // The standard deviation of a length is 0.67, that of the mean of 200000 is 0.0015: six of them.
  BOOST_TEST(std::abs(sum / kCount - kMeanOfNoise) < 0.009);
}

BOOST_AUTO_TEST_CASE(the_caveat_tells_the_noise_and_a_synthetic_origin) {
  auto made = recording(kTimes);
  BOOST_TEST(RecordedMotion(made, 0, scene()).caveat().find("noise of 0.001 m") != std::string::npos);
  BOOST_TEST(RecordedMotion(made, 0, scene()).caveat().find("synthetic") == std::string::npos);
  made->synthetic = "core";
  BOOST_TEST(RecordedMotion(made, 0, scene()).caveat().find("synthetic: 'core'") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
