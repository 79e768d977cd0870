// phase_error on runs that are the truth itself, taken late or early by a known time.
#include <boost/test/unit_test.hpp>
#include <numbers>

#include "tests/cases/judged.h"

using namespace rigor;

namespace {

using Motion = std::function<BodyState(double t)>;

BodyState swinging(double t) {  // 3 rad/s
  BodyState state;
  state.position = {2 * std::cos(3 * t), 1, 0}, state.velocity = {-6 * std::sin(3 * t), 0, 0};
  return state;
}

BodyState spinning(double t) {  // 4 rad/s about a slanted axis
  const Vec3 axis = Vec3(1, 2, 2) / 3;
  BodyState state;
  state.orientation = rotation_by(4 * t * axis), state.angular_velocity = 4 * axis;
  return state;
}

BodyState passing(double t) {
  BodyState state;
  state.position = {0, 5 * t, 0}, state.velocity = {0, 5, 0};
  return state;
}

MetricResult phase_of(const Motion& truth_motion, const Motion& run_motion, double dt, int steps) {
  Scene scene;
  scene.bodies = {test::body("b", 2, {1, 2, 3})};
  const test::StatedTruth truth(truth_motion), run(run_motion);
  const Trajectory trajectory = test::played(run, scene, dt, steps);
  const TruthSamples samples = test::sampled(truth, trajectory, scene, 1);
  return test::measured("phase_error", {scene, trajectory, &samples, 0});
}

double shift_of(const Motion& truth, const Motion& run, double dt = 0.05, int steps = 200) {
  const MetricResult result = phase_of(truth, run, dt, steps);
  BOOST_TEST_REQUIRE(result.measurement.has_value(), result.not_applicable);
  return result.measurement->value;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cases_metrics_phase_error)

BOOST_AUTO_TEST_CASE(a_run_that_is_late_lags_and_one_that_is_early_leads) {
  struct Row {
    const char* name;
    Motion motion;
  };
  for (const Row& row : {Row{"swinging", swinging}, Row{"spinning", spinning}, Row{"passing", passing}}) {
    for (const double lag : {0.0, 0.4, 0.013, -1e-7, -0.25}) {
      const double found = shift_of(row.motion, [&](double t) { return row.motion(t - lag); });
      BOOST_TEST_CONTEXT(row.name << " late by " << lag) {
        BOOST_TEST(std::abs(found - lag) < 1e-12);  // s: the root is sought to 1e-12 dt; roundings of numbers near 10
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_clock_that_runs_slow_is_late_by_its_mean_over_the_run) {
  // x(t) = X(t - e t) of uniform motion: the mean of (s - e t)² is least at s = e T/2.
  BOOST_TEST(shift_of(passing, [](double t) { return passing(0.99 * t); }) == 0.01 * 10 / 2,
             boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(another_amplitude_or_place_is_not_a_lag) {
  // Sampled evenly about the instants at which the swing turns: what is off is even in time, a shift is odd.
  const double period = 2 * std::numbers::pi / 3;
  const auto larger = [](double t) {
    BodyState state = swinging(t);
    state.position.x() *= 1.3, state.position.y() += 0.2;
    return state;
  };
  BOOST_TEST(std::abs(shift_of(swinging, larger, period / 40, 160)) < 1e-9);
}

BOOST_AUTO_TEST_CASE(a_lag_of_more_than_half_a_period_is_a_lead) {
  const double period = 2 * std::numbers::pi / 4;
  const double found = shift_of(spinning, [&](double t) { return spinning(t - 0.8 * period); });
  BOOST_TEST(found == -0.2 * period, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(what_stands_still_or_is_beyond_the_search_has_no_phase) {
  const auto resting = [](double) { return BodyState(); };
  BOOST_TEST(phase_of(resting, resting, 0.1, 100).not_applicable == "the truth does not move");
  const auto trembling = [](double t) {  // by less than a nanometre
    BodyState state;
    state.position.x() = 1e-10 * std::sin(3 * t), state.velocity.x() = 3e-10 * std::cos(3 * t);
    return state;
  };
  BOOST_TEST(phase_of(trembling, trembling, 0.1, 100).not_applicable == "the truth does not move");
  BOOST_TEST(!phase_of(resting, passing, 0.1, 100).measurement.has_value());
  const auto too_late = [](double t) { return passing(t - 4); };
  const std::string why = phase_of(passing, too_late, 0.1, 100).not_applicable;
  BOOST_TEST(why.find("2.5 s") != std::string::npos, why);  // a quarter of the run
  BOOST_TEST(phase_of(passing, passing, 0.5, 1).not_applicable.find("too few samples") != std::string::npos);
  const auto lost = [](double t) {
    BodyState state = passing(t);
    state.position *= t > 0 ? 1e200 : 1;
    return state;
  };
  BOOST_TEST(!phase_of(passing, lost, 0.1, 100).measurement.has_value());
}

BOOST_AUTO_TEST_SUITE_END()
