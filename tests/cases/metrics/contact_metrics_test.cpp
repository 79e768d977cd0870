// The metrics of contact on runs whose every error is put there on purpose.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_contact_metrics)

namespace {

constexpr double kDt = 0.01;

BodyState at(const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  return {position, Quat::Identity(), velocity, Vec3::Zero()};
}

// A run of the scene's first body as a formula; the others stand.
Trajectory run_of(const Scene& scene, const std::function<BodyState(double)>& motion, int steps) {
  Trajectory run{kDt, {}};
  for (int n = 0; n <= steps; ++n) {
    BodyTable table(scene.bodies.size());
    table.columns().set_body(0, motion(n * kDt));
    for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      table.columns().set_body(i, {body.position, body.orientation, body.velocity, body.angular_velocity});
    }
    run.samples.push_back({n * kDt, table});
  }
  return run;
}

Scene ball_on_ground(double height, double restitution, double friction) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("ball", Sphere{0.5}, 2, {0, 0, 0.5 + height}), test::plane()};
  scene.contact_default = {restitution, friction};
  return scene;
}

// Dropped from 5 m it hits at 10 m/s after 1 s (and `late`), and leaves at `speed`.
BodyState bounced(double t, double speed, double late = 0) {
  const double hit = 1 + late;
  if (t < hit) return at({0, 0, 5.5 - 5 * t * t}, {0, 0, -10 * t});
  const double since = t - hit, start = 5.5 - 5 * hit * hit;
  return at({0, 0, start + speed * since - 5 * since * since}, {0, 0, speed - 10 * since});
}

double value_of(const std::string& metric, const JudgedRun& run) {
  const MetricResult result = test::measured(metric, run);
  BOOST_TEST_REQUIRE(result.measurement.has_value(), metric << ": " << result.not_applicable);
  return result.measurement->value;
}

std::string reason_of(const std::string& metric, const JudgedRun& run) {
  return test::measured(metric, run).not_applicable;
}

}  // namespace

BOOST_AUTO_TEST_CASE(penetration_is_the_deepest_overlap_and_names_its_body) {
  const Scene scene = ball_on_ground(1, 0, 0);
  const Trajectory run = run_of(
      scene,
      [](double t) {
        return at({0, 0, 0.5 + 0.1 * std::cos(10 * t)});
      },
      100);
  const MetricResult result = test::measured("penetration", {scene, run, nullptr, 0});
  // cos(10 t) is sampled every 0.1 rad: the deepest sample misses -1 by at most (0.05)²/2.
  BOOST_TEST(std::abs(result.measurement->value - 0.1) < 0.1 * 0.00125);
  BOOST_TEST(result.measurement->worst.body == 0);
  BOOST_TEST(result.measurement->series.size() == 101);
}

BOOST_AUTO_TEST_CASE(an_overlap_that_the_scene_starts_with_does_not_count) {
  Scene scene = ball_on_ground(-0.2, 0, 0);
  const Trajectory run = run_of(
      scene,
      [](double t) {
        return at({0, 0, 0.3 - 0.01 * t});
      },
      100);
  BOOST_TEST(value_of("penetration", {scene, run, nullptr, 0}) == 0.01, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(the_energy_gain_is_the_rise_above_the_lowest_before_and_not_above_the_start) {
  // 2 kg over 5 m of fall, 100 J in play: it comes down to 1 m and is lifted to 3 m, which is below its start.
  const Scene scene = ball_on_ground(5, 0, 0);
  const auto height = [](double t) { return t < 0.3 ? 5.5 : t < 0.6 ? 1.5 : t < 0.9 ? 3.5 : 2.5; };
  const Trajectory run = run_of(
      scene,
      [&](double t) {
        return at({0, 0, height(t)});
      },
      100);
  BOOST_TEST(value_of("energy_gain", {scene, run, nullptr, 0}) == 0.4, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(value_of("energy_gain", {scene, run, nullptr, 0.5}) == 0.4, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(the_restitution_error_finds_what_an_impact_made_of_the_speed) {
  const Scene scene = ball_on_ground(5, 0.6, 0);
  for (const double speed : {6.0, 7.0, 3.0, 10.0}) {
    // At any lateness below a step, so that the impact falls anywhere between two samples.
    for (const double late : {0.0, 0.003, 0.0071}) {
      const Trajectory run = run_of(
          scene, [&](double t) { return bounced(t, speed, late); }, 150);
      const JudgedRun judged{scene, run, nullptr, 0};
      // It leaves from below the ground, at 5 late² + 10 late: 0.14 m at most, which takes a share of the speed.
      const double depth = 10 * late + 5 * late * late, after = std::sqrt(speed * speed - 20 * depth);
      BOOST_TEST(std::abs(value_of("restitution_error", judged) - std::abs(after / 10 - 0.6)) < 1e-7);
    }
  }
}

// It leaves at 3 instead of 6 m/s, comes back after 0.6 s and leaves at 1.8, as it should.
BOOST_AUTO_TEST_CASE(of_several_impacts_the_one_furthest_off_counts_and_the_first_of_those_as_far) {
  Scene scene = ball_on_ground(5, 0.6, 0);
  const auto twice = [](double t) {
    const double since = t - 1.6;
    return t < 1.6 ? bounced(t, 3) : at({0, 0, 0.5 + 1.8 * since - 5 * since * since}, {0, 0, 1.8 - 10 * since});
  };
  Trajectory run = run_of(scene, twice, 190);
  const Measurement one = *test::measured("restitution_error", {scene, run, nullptr, 0}).measurement;
  BOOST_TEST(std::abs(one.value - 0.3) < 1e-7);
  BOOST_TEST(one.worst.time == 1, boost::test_tools::tolerance(1e-9));
  scene.bodies.push_back(scene.bodies[0]);  // one that does the same beside it
  for (Sample& sample : run.samples) {
    const BodyState ball = sample.bodies.columns().body(0);
    sample.bodies.resize(3);
    for (const std::size_t i : {0, 2}) sample.bodies.columns().set_body(i, ball);
    sample.bodies.columns().set_orientation(1, Quat::Identity());
    sample.bodies.columns().set_position(2, ball.position + Vec3(9, 0, 0));
  }
  BOOST_TEST(test::measured("restitution_error", {scene, run, nullptr, 0}).measurement->worst.body == 0);
}

BOOST_AUTO_TEST_CASE(velocities_half_a_step_behind_are_brought_forward_first) {
  const Scene scene = ball_on_ground(5, 0.6, 0);
  const Trajectory run = run_of(
      scene,
      [](double t) {
        BodyState state = bounced(t, 6);
        state.velocity.z() += 0.5 * kDt * 10;
        return state;
      },
      150);
  BOOST_TEST(value_of("restitution_error", {scene, run, nullptr, 0.5}) < 1e-7);
  BOOST_TEST(value_of("restitution_error", {scene, run, nullptr, 0}) > 1e-3);
}

BOOST_AUTO_TEST_CASE(a_ball_that_does_not_leave_has_a_restitution_of_zero) {
  const Scene scene = ball_on_ground(5, 0.6, 0);
  const Trajectory run = run_of(
      scene,
      [](double t) {
        return t < 1 ? bounced(t, 6) : at({0, 0, 0.5});
      },
      150);
  BOOST_TEST(value_of("restitution_error", {scene, run, nullptr, 0}) == 0.6, boost::test_tools::tolerance(1e-7));
}

BOOST_AUTO_TEST_CASE(the_impact_time_error_is_the_impacts_lateness) {
  const Scene scene = ball_on_ground(5, 0.6, 0);
  const auto truth = make_truth("bounce", scene, 2);
  for (const double late : {0.0, 0.003, 0.03}) {
    // Leaves the ground late, from the ground.
    const auto motion = [&](double t) {
      if (t < 1) return bounced(t, 6);
      return t < 1 + late ? at({0, 0, 0.5}) : bounced(t - late, 6);
    };
    const Trajectory run = run_of(scene, motion, 180);
    const TruthSamples samples = test::sampled(*truth, run, scene, 100);
    BOOST_TEST(std::abs(value_of("impact_time_error", {scene, run, &samples, 0}) - late) < 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(an_impact_that_never_comes_is_late_by_the_rest_of_the_run) {
  const Scene scene = ball_on_ground(5, 0.6, 0);
  const auto truth = make_truth("bounce", scene, 2);
  const Trajectory run = run_of(
      scene,
      [](double t) {
        return at({0, 0, 5.5 + t});
      },
      180);
  const TruthSamples samples = test::sampled(*truth, run, scene, 100);
  BOOST_TEST(std::abs(value_of("impact_time_error", {scene, run, &samples, 0}) - 0.8) < 1e-6);
}

BOOST_AUTO_TEST_CASE(energy_gain_counts_rises_above_the_lowest_and_no_losses) {
  const Scene scene = ball_on_ground(5, 0.6, 0);
  const auto gain = [&](double speed) {
    const Trajectory run = run_of(
        scene, [&](double t) { return bounced(t, speed); }, 150);
    const auto truth = make_truth("bounce", scene, 2);
    const TruthSamples samples = test::sampled(*truth, run, scene, 100);
    return value_of("energy_gain", {scene, run, &samples, 0});
  };
  BOOST_TEST(gain(6) < 1e-12);
  BOOST_TEST(gain(1) < 1e-12);
  BOOST_TEST(gain(11) == 0.21, boost::test_tools::tolerance(1e-10));  // of 100 J, 1/2 x 2 kg x (11² - 10²)
}

BOOST_AUTO_TEST_CASE(a_distance_to_a_stop_is_judged_relative_to_the_true_one) {
  const Scene scene = test::on_slope(Box{{0.4, 0.4, 0.2}}, 0, 0.5, 5);
  const auto truth = make_truth("sliding", scene, 3);
  const double stop = 25 / 9.81;
  for (const double share : {1.0, 1.1, 0.71}) {
    const Trajectory run = run_of(
        scene,
        [&](double t) {
          return at({std::min(5 * t, share * stop), 0, 0.1});
        },
        200);
    const TruthSamples samples = test::sampled(*truth, run, scene, 25);
    BOOST_TEST(std::abs(value_of("stop_distance_error", {scene, run, &samples, 0}) - std::abs(share - 1)) < 1e-12);
    // A truth that does not know its own place to better than that knows of no stop.
    TruthSamples unsure = samples;
    unsure.error.assign(samples.error.size(), 1.1 * stop);
    BOOST_TEST(reason_of("stop_distance_error", {scene, run, &unsure, 0}) != "");
  }
}

BOOST_AUTO_TEST_CASE(anisotropy_is_the_spread_over_directions) {
  Scene scene = test::on_slope(Box{{0.4, 0.4, 0.2}}, 0, 0.5, 5);
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[2].position.y() = 3, scene.bodies[2].velocity = {0, 5, 0};
  const auto truth = make_truth("sliding", scene, 3);
  const double stop = 25 / 9.81;
  Trajectory run = run_of(
      scene,
      [&](double t) {
        return at({std::min(5 * t, 0.71 * stop), 0, 0.1});
      },
      200);
  run.samples.back().bodies.columns().set_position(2, {0, 3 + 1.01 * stop, 0.1});
  const TruthSamples samples = test::sampled(*truth, run, scene, 25);
  BOOST_TEST(value_of("friction_anisotropy", {scene, run, &samples, 0}) == 0.3, boost::test_tools::tolerance(1e-10));
}

BOOST_AUTO_TEST_CASE(creep_and_collapse_follow_a_body_that_leaves_its_place) {
  const Scene scene = ball_on_ground(0, 0, 0);
  const Trajectory run = run_of(
      scene,
      [](double t) {
        return at({0.3 * t, 0, 0.5});
      },
      200);
  const JudgedRun judged{scene, run, nullptr, 0};
  BOOST_TEST(value_of("creep", judged) == 0.6, boost::test_tools::tolerance(1e-12));
  // Half its radius, 0.25 m, is passed after 0.8333 s.
  BOOST_TEST(value_of("collapse_time", judged) == 0.84, boost::test_tools::tolerance(1e-12));
  const Trajectory stands = run_of(
      scene,
      [](double) {
        return at({0, 0, 0.5});
      },
      200);
  BOOST_TEST(value_of("collapse_time", {scene, stands, nullptr, 0}) == 2);
  BOOST_TEST(value_of("creep", {scene, stands, nullptr, 0}) == 0);
}

BOOST_AUTO_TEST_CASE(what_does_not_apply_says_why) {
  Scene scene = ball_on_ground(5, 0.6, 0);
  const Trajectory run = run_of(
      scene, [](double t) { return bounced(t, 6); }, 150);
  const JudgedRun judged{scene, run, nullptr, 0};
  BOOST_TEST(reason_of("impact_time_error", judged) == "the case has no truth");
  BOOST_TEST(reason_of("stop_distance_error", judged) == "no finite friction brings a body to a stop");
  BOOST_TEST(reason_of("creep", judged) == "a body starts without touching another");
  BOOST_TEST(reason_of("collapse_time", judged) == "a body starts without touching another");
  scene.bodies[0].collides = false;
  BOOST_TEST(reason_of("penetration", judged) == "no two bodies of the scene can touch");
  BOOST_TEST(reason_of("restitution_error", judged) == "no two bodies run into each other");
}

BOOST_AUTO_TEST_SUITE_END()
