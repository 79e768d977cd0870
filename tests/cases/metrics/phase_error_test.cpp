// phase_error on runs that are the truth itself, taken late or early by a known time.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_phase_error)

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

// 2 sin(3 t) m: half the mean square distance from its start is 1 m², and its mean square speed 18 m²/s².
BodyState swinging_about_its_start(double t) {
  BodyState state;
  state.position = {2 * std::sin(3 * t), 0, 0}, state.velocity = {6 * std::cos(3 * t), 0, 0};
  return state;
}

// How often the truth is asked for each of the samples that are compared: so many shifts were tried.
double shifts_tried(const Motion& motion, double lag, double dt, int steps, std::size_t compared,
                    bool is_jointed = false) {
  std::size_t asked = 0;
  bool counts = false;
  const double found = [&] {
    Scene scene;
    scene.bodies = {test::body("b", 2, {1, 2, 3})};
    if (is_jointed) scene.joints = {{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitY()}}};
    const test::StatedTruth run([&](double t) { return motion(t - lag); });
    const test::StatedTruth truth([&](double t) {
      asked += counts;
      return motion(t);
    });
    const Trajectory trajectory = test::played(run, scene, dt, steps);
    const TruthSamples samples = test::sampled(truth, trajectory, scene, 1);
    counts = true;
    const MetricResult result = test::measured("phase_error", {scene, trajectory, &samples, 0});
    BOOST_TEST_REQUIRE(result.measurement.has_value(), result.not_applicable);
    return result.measurement->value;
  }();
  BOOST_TEST(std::abs(found - lag) < 1e-11, found << " of " << lag);
  return static_cast<double>(asked) / static_cast<double>(compared);
}

}  // namespace

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

// A run that lags by 0.3 s in its first second alone, in which an oscillation of 3 rad/s is eight times as large as at
// the end. Half a period is 1.05 s: to leave that out at each end would leave out all of the lag.
BOOST_AUTO_TEST_CASE(a_lag_in_the_first_half_period_counts) {
  const auto damped = [](double t) {
    BodyState state = swinging(t);
    const double size = std::exp(-0.2 * t);
    state.position.x() *= size, state.velocity.x() = size * (state.velocity.x() - 0.2 * 2 * std::cos(3 * t));
    return state;
  };
  const auto late_at_first = [&](double t) { return damped(t < 1 ? std::max(0.0, t - 0.3) : t); };
  // The least misfit over all samples by trying shifts 1 ms apart.
  double best = 0, least = 1e9;
  for (double shift = -0.2; shift < 0.2; shift += 1e-3) {
    double misfit = 0;
    for (int n = 0; n <= 200; ++n) {
      const double t = 0.05 * n, away = late_at_first(t).position.x() - damped(t - shift).position.x();
      misfit += away * away;
    }
    if (misfit < least) least = misfit, best = shift;
  }
  BOOST_TEST(best > 0.02);
  // The first three of the 201 samples are left out, 0.065 s of search and the shift, which weigh 3 of 20.
  BOOST_TEST(shift_of(damped, late_at_first) == best, boost::test_tools::tolerance(0.25));
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

// Of a turn half a period, 0.785 s: 0.53 of it late is 0.47 of it early.
BOOST_AUTO_TEST_CASE(the_search_goes_half_a_period_of_the_faster_motion_either_way) {
  const double period = 2 * std::numbers::pi / 4;
  BOOST_TEST(shift_of(spinning, [&](double t) { return spinning(t - 0.53 * period); }) == -0.47 * period,
             boost::test_tools::tolerance(1e-9));
  const auto both = [](double t) {
    BodyState state = spinning(t);
    state.position = swinging_about_its_start(t).position, state.velocity = swinging_about_its_start(t).velocity;
    return state;
  };
  BOOST_TEST(shift_of(both, [&](double t) { return both(t - 0.3); }) == 0.3, boost::test_tools::tolerance(1e-9));
  // Of a swing about its start 1/√2 of a period counts as one: 0.74 s are half of that.
  const std::string why = phase_of(
                              both, [&](double t) { return both(t - 0.9); }, 0.05, 200)
                              .not_applicable;
  BOOST_TEST(why.starts_with("the best shift is 0.74"), why);
}

// A vibration of 1e-7 m at 300 rad/s has 2e-11 of the energy of the spin, and at ten times the frequency 2e-9. Its
// period of 21 ms or 2 ms then ends the search. The same holds for a swing that vibrates as it rotates.
BOOST_AUTO_TEST_CASE(a_trace_of_motion_says_nothing_of_the_period) {
  const auto trembling_spin = [](double speed) {
    return [speed](double t) {
      BodyState state = spinning(t);
      state.position.x() = 1e-7 * std::sin(300 * t), state.velocity.x() = speed * std::cos(300 * t);
      return state;
    };
  };
  const auto trembling_swing = [](double speed) {
    return [speed](double t) {
      BodyState state = swinging_about_its_start(t);
      state.orientation = rotation_by({1e-7 * std::sin(300 * t), 0, 0});
      state.angular_velocity.x() = speed * std::cos(300 * t);
      return state;
    };
  };
  for (const Motion& motion : {Motion(trembling_spin(3e-5)), Motion(trembling_swing(3e-5))}) {
    const auto late = [&](double t) { return motion(t - 0.2); };
    BOOST_TEST(shift_of(motion, late) == 0.2, boost::test_tools::tolerance(1e-5));
  }
  for (const Motion& motion : {Motion(trembling_spin(1e-3)), Motion(trembling_swing(1e-3))}) {
    const auto late = [&](double t) { return motion(t - 0.2); };
    BOOST_TEST(phase_of(motion, late, 0.05, 200).not_applicable.find("or more, where the search ends") !=
               std::string::npos);
  }
}

// 1.2 nm at all samples but the first are more than a nanometre, and 0.8 nm are not, whatever the mass.
BOOST_AUTO_TEST_CASE(what_moves_by_more_than_a_nanometre_moves) {
  const auto why_of = [](double far) {
    const auto moved = [far](double t) {
      BodyState state;
      state.position.x() = t > 0 ? far : 0, state.velocity.x() = 1e-9;
      return state;
    };
    return phase_of(moved, moved, 0.1, 100).not_applicable;
  };
  BOOST_TEST(why_of(0.8e-9) == "the truth does not move");
  BOOST_TEST(why_of(1.2e-9) != "the truth does not move");
  // What is elsewhere without ever having a speed is not moving.
  for (const bool turns : {true, false}) {
    const auto displaced = [=](double t) {
      BodyState state;
      if (turns) state.orientation = rotation_by({0.1 * t, 0, 0});
      if (!turns) state.position.x() = t;
      return state;
    };
    BOOST_TEST(phase_of(displaced, displaced, 0.1, 100).not_applicable == "the truth does not move");
  }
}

BOOST_AUTO_TEST_CASE(the_samples_a_quarter_from_both_ends_are_three_at_least) {
  BOOST_TEST(phase_of(passing, passing, 1, 3).not_applicable.find("too few samples") != std::string::npos);
  const MetricResult three = phase_of(
      passing, [](double t) { return passing(t - 0.5); }, 1, 4);
  BOOST_TEST_REQUIRE(three.measurement.has_value(), three.not_applicable);
  const Measurement& found = *three.measurement;
  BOOST_TEST(found.value == 0.5, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(found.worst.component == "shift");
  BOOST_TEST(found.worst.body == kWorld);
  BOOST_TEST(found.worst.time == 4);
  BOOST_TEST(found.worst.found == found.value);
  BOOST_TEST(found.compared_until == 4);
}

// The truth's samples tell which shift is the best one, however far apart they are. The truth itself is asked there, at
// both beside it, and as often between these as the root of the slope takes, which of an even motion is once. Of the
// 101 samples of a swing and of a spin, and of the 81 of passing, those nearer to an end than the shift are left out.
BOOST_AUTO_TEST_CASE(the_truth_is_asked_at_few_shifts) {
  for (const double lag : {0.4, -0.4, 0.02, 0.6}) {
    BOOST_TEST(shifts_tried(swinging_about_its_start, lag, 0.2, 100, 101) <= 8);
    BOOST_TEST(shifts_tried(spinning, lag, 0.2, 100, 101) <= 13);
    const double passes = shifts_tried(passing, lag * 5, 0.5, 80, 81);
    BOOST_TEST(passes > 3);
    BOOST_TEST(passes < 4);
  }
}

// Of 500 samples, or of joints 40, every second one is asked for. A 64th of the run is left out at each end: of 517
// steps, 9 samples.
BOOST_AUTO_TEST_CASE(of_many_samples_some_are_compared) {
  // A whole number of shifts: three, and one to four for the root.
  const auto is_few = [](double shifts) {
    BOOST_TEST_CONTEXT(shifts << " shifts") BOOST_TEST((shifts >= 4 && shifts <= 7 && shifts == std::round(shifts)));
  };
  is_few(shifts_tried(passing, 0.01, 0.05, 517, 250));
  is_few(shifts_tried(passing, 0.01, 0.05, 516, 499));
  is_few(shifts_tried(passing, 0.01, 0.05, 41, 20, true));
  is_few(shifts_tried(passing, 0.01, 0.05, 40, 39, true));
}

// Samples with reversed velocities lead to a neighbour of the best shift. The truth itself leads on from there in
// either direction.
BOOST_AUTO_TEST_CASE(where_samples_mislead_the_truth_itself_is_followed) {
  const auto backwards = [](double t) {
    BodyState state = passing(t);
    if (std::abs(std::remainder(t, 5)) < 1e-6) state.velocity = -state.velocity;
    return state;
  };
  // With shifts of 6.25 s the third is the nearest to 17 s, and the second seems to be.
  for (const double lag : {17.0, -17.0, 23.0, -23.0, 30.0, -30.0})
    BOOST_TEST(shifts_tried(backwards, lag, 5, 80, 41) < 30);
}

// A truth whose velocities do not match its positions: they are 0.5 m/s, except at the instants that one of the shifts
// beside the best evaluates. The misfit is still a parabola with its vertex at the lag. Of shifts by 2.5/16 s the
// third, 0.46875 s, is best; its neighbours evaluate samples, 0.05 s apart, minus 0.3125 s and minus 0.625 s.
BOOST_AUTO_TEST_CASE(where_the_slope_has_no_root_the_vertex_of_the_misfit_counts) {
  for (const double beside : {0.0375, 0.025}) {
    for (const double speed : {-0.5, 0.0}) {
      const auto truth = [=](double t) {
        BodyState state;
        const double into = std::fmod(t + 10, 0.05);
        const bool is_asked_beside = std::abs(into - beside) < 1e-6;
        state.position.y() = 0.5 * t, state.velocity.y() = is_asked_beside ? speed : 0.5;
        return state;
      };
      const auto late = [=](double t) {
        BodyState state;
        state.position.y() = 0.5 * (t - 0.4);
        return state;
      };
      BOOST_TEST_CONTEXT(beside << " " << speed)
      BOOST_TEST(shift_of(truth, late) == 0.4, boost::test_tools::tolerance(1e-9));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
