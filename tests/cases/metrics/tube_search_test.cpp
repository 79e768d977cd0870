// When tube evaluates the truth between samples, which is slow, and where it finds the nearest instant. One of several
// bodies has an error, and the truths count their evaluations.
#include <boost/test/unit_test.hpp>
#include <numbers>

#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_tube_search)

namespace {

using Motion = std::function<BodyState(double t)>;

// For any number of bodies; counts its evaluations.
class CountedTruth : public Truth {
 public:
  explicit CountedTruth(std::vector<Motion> bodies) : bodies_(std::move(bodies)) {}
  void at(double t, MutableBodyColumns out) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) out.set_body(i, bodies_[i](t));
    asked.push_back(t);
  }
  double error(double) const override { return 0; }
  mutable std::vector<double> asked;

 private:
  std::vector<Motion> bodies_;
};

BodyState state(const Vec3& position, const Vec3& velocity, const Vec3& angular_velocity = Vec3::Zero()) {
  return {position, Quat::Identity(), velocity, angular_velocity};
}

struct Found {
  Measurement measured;
  std::vector<double> asked;  // s
};

Found tube_of(const std::vector<Motion>& truth_motions, const std::vector<Motion>& run_motions, double dt, int steps,
              bool is_jointed = false) {
  Scene scene;
  for (std::size_t i = 0; i < truth_motions.size(); ++i) scene.bodies.push_back(test::body("b", 2, {1, 2, 3}));
  if (is_jointed) scene.joints = {{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}}};
  const CountedTruth truth(truth_motions), run(run_motions);
  const Trajectory trajectory = test::played(run, scene, dt, steps);
  const TruthSamples samples = test::sampled(truth, trajectory, scene, 1);
  truth.asked.clear();
  const MetricResult result = test::measured("tube", {scene, trajectory, &samples, 0});
  BOOST_TEST_REQUIRE(result.measurement.has_value(), result.not_applicable);
  return {*result.measurement, truth.asked};
}

}  // namespace

// A truth that says that it has a speed, and stays: what may be gained by it is known to the last digit. At a tolerance
// of 1 mm a second 0.5 s are half of one, twice that is allowed for: what is 2 tolerances off may be 1 off.
BOOST_AUTO_TEST_CASE(the_truth_is_asked_where_a_step_might_bring_it_near_enough) {
  for (const auto& [off, is_asked] : {std::pair{1e-3, false}, {1.01e-3, true}, {2e-3, true}, {2.01e-3, false}}) {
    const Found found = tube_of({[](double) {
                                  return state({0, 0, 0}, {0, 1e-3, 0});
                                }},
                                {[off](double) {
                                  return state({0, off, 0}, {0, 0, 0});
                                }},
                                0.5, 6);
    BOOST_TEST(!found.asked.empty() == is_asked, off);
    BOOST_TEST(found.measured.value == (off <= 1e-3 ? 1 : 0));
  }
}

BOOST_AUTO_TEST_CASE(turning_may_bring_it_near_as_well) {
  const double tolerance = 0.01 * std::numbers::pi;
  for (const auto& [off, is_asked] : {std::pair{0.9, false}, {1.9, true}, {2.1, false}}) {
    const auto turned = [=](double) {
      BodyState now = state({0, 0, 0}, {0, 0, 0});
      now.orientation = rotation_by({0, 0, off * tolerance});
      return now;
    };
    const Motion turning = [=](double) { return state({0, 0, 0}, {0, 0, 0}, {0, 0, tolerance}); };
    BOOST_TEST(!tube_of({turning}, {turned}, 0.5, 6).asked.empty() == is_asked, off);
  }
}

// The truth moves at 1 m/s for an instant, sample 5; the run is 0.1 m ahead. The possible gain follows from the fastest
// of three samples.
BOOST_AUTO_TEST_CASE(the_fastest_of_the_samples_before_and_after_counts) {
  for (const int rush : {0, 5, 10}) {
    const auto rushing = [=](double t) {
      return state({0, 0, 0}, {0, std::lround(10 * t) == rush && std::abs(10 * t - rush) < 1e-6 ? 1.0 : 1e-3, 0});
    };
    const Found found = tube_of({rushing}, {[](double) { return state({0, 0.1, 0}, {0, 0, 0}); }}, 0.1, 10);
    // Forward, to the end of the step after each of those samples.
    for (int n = 0; n <= 10; ++n) {
      const bool is_asked = std::any_of(found.asked.begin(), found.asked.end(),
                                        [=](double t) { return std::abs(10 * t - std::min(10, n + 1)) < 1e-6; });
      const bool is_near = std::abs(n - rush) <= 1;
      // The last two samples ask for the same instant.
      if (n < 9) BOOST_TEST(is_asked == is_near, rush << " " << n);
    }
    BOOST_TEST(!found.asked.empty());
  }
}

// Round a circle of 1 m at 1 rad/s the nearest instant is found to all digits, in four rounds at most.
BOOST_AUTO_TEST_CASE(the_nearest_instant_of_a_curved_path_is_found) {
  const auto round = [](double t) { return state({std::cos(t), std::sin(t), 0}, {-std::sin(t), std::cos(t), 0}); };
  // Half a step late and 0.0279 m too far out, of 0.0282 m: a hundredth of the box of 2 m by 2 m.
  const double dt = 0.4;
  const auto late = [=](double t) {
    BodyState now = round(std::max(0.0, t - dt / 2));
    now.position *= 1.0279;
    return now;
  };
  BOOST_TEST(tube_of({round}, {late}, dt, 16).measured.value == 1);
  const auto out = [=](double t) {
    BodyState now = round(std::max(0.0, t - dt / 2));
    now.position *= 1.05;
    return now;
  };
  const Found outside = tube_of({round}, {out}, dt, 16);
  BOOST_TEST(outside.measured.value == 0);
  // The first sample is at the nearest instant already.
  BOOST_TEST(outside.asked.size() <= 4 * 17u);
  BOOST_TEST(outside.asked.size() > 3 * 16u);
  // Samples 0.4 rad apart miss a circle's edges by up to 0.2²/2 of its radius.
  BOOST_TEST(outside.measured.worst.found == 0.05 / (0.01 * 2 * std::numbers::sqrt2),
             boost::test_tools::tolerance(0.02));
}

// Whichever of two bodies is off; each by its own tolerance, the second's ten times the first's.
BOOST_AUTO_TEST_CASE(every_body_has_to_be_inside) {
  const Motion slow = [](double t) { return state({t, 0, 0}, {1, 0, 0}); };
  const Motion fast = [](double t) { return state({0, 10 * t, 0}, {0, 10, 0}); };
  for (const int off : {0, 1}) {
    for (const auto& [share, value] : {std::pair{0.99, 1.0}, {1.01, 0.0}}) {
      const auto aside = [&](const Motion& motion, double by) {
        return Motion([=](double t) {
          BodyState now = motion(t);
          now.position.z() += by;
          return now;
        });
      };
      const Found found = tube_of(
          {slow, fast}, {aside(slow, off == 0 ? 0.01 * share : 0), aside(fast, off == 1 ? 0.1 * share : 0)}, 0.1, 10);
      BOOST_TEST(found.measured.value == value, off << " " << share);
      BOOST_TEST(found.measured.worst.body == off);
    }
  }
  // Half a step late, both of them or one: it is one instant at which all have to be near.
  const auto late = [](const Motion& motion, double lag) {
    return Motion([=](double t) { return motion(std::max(0.0, t - lag)); });
  };
  const auto value = [&](double lag_of_slow, double lag_of_fast) {
    return tube_of({slow, fast}, {late(slow, lag_of_slow), late(fast, lag_of_fast)}, 0.1, 10).measured.value;
  };
  BOOST_TEST(value(0.05, 0.05) == 1);
  BOOST_TEST(value(0.05, 0) < 0.2);
  BOOST_TEST(value(0, 0.05) < 0.2);
  // 3 and 4.5 tolerances: halfway both are within one, where each counts by its own.
  BOOST_TEST(value(0.03, 0.045) == 1);
}

// 1 m/s along 1 m and 10 rad/s: late by one tolerance of the path and 0.95 of the turn, 0.64 and 0.2 at best.
BOOST_AUTO_TEST_CASE(places_and_turns_count_each_by_its_own_tolerance) {
  const auto rolling = [](double t, double turned_at) {
    BodyState now = state({t, 0, 0}, {1, 0, 0}, {0, 0, 10});
    now.orientation = rotation_by({0, 0, 10 * turned_at});
    return now;
  };
  const auto late = [&](double t) { return rolling(std::max(0.0, t - 0.01), std::max(0.0, t - 0.003)); };
  BOOST_TEST(tube_of({[&](double t) { return rolling(t, t); }}, {late}, 0.1, 10).measured.value == 1);
}

// At 0.8 tolerances a second and 1.6 s late it is 1.28 behind, of which half a second makes up 0.4.
BOOST_AUTO_TEST_CASE(a_slow_body_is_followed_as_far_as_a_step_goes) {
  const auto slow = [](double t) { return state({0.8e-3 * t, 0, 0}, {0.8e-3, 0, 0}); };
  const auto late = [&](double t) { return slow(std::max(0.0, t - 1.6)); };
  BOOST_TEST(tube_of({slow}, {late}, 0.5, 8).measured.value == 1);
}

// The first of several bodies with equal errors is named.
BOOST_AUTO_TEST_CASE(of_two_that_are_as_far_off_the_first_is_named) {
  const Motion rest =
                   [](double) {
                     return state({0, 0, 0}, {0, 0, 0});
                   },
               off = [](double) {
                 return state({0, 0.5, 0}, {0, 0, 0});
               };
  BOOST_TEST(tube_of({rest, rest}, {off, off}, 0.1, 10).measured.worst.body == 0);
}

// A turn alone is followed in time as a path is: 1 rad/s, half a step late.
BOOST_AUTO_TEST_CASE(a_late_turn_is_inside) {
  const auto turning = [](double t) {
    BodyState now = state({0, 0, 0}, {0, 0, 0}, {0, 0, 1});
    now.orientation = rotation_by({0, 0, t});
    return now;
  };
  const Found found = tube_of({turning}, {[&](double t) { return turning(std::max(0.0, t - 0.05)); }}, 0.1, 10);
  BOOST_TEST(found.measured.value == 1);
}

// Beyond ten thousand samples every second one is asked, of joints beyond a thousand.
BOOST_AUTO_TEST_CASE(of_very_many_samples_every_second_one_is_looked_at) {
  const Motion rest = [](double) { return state({0, 0, 0}, {0, 0, 0}); };
  const Motion off_at_odd = [](double t) {
    return state({0, std::lround(1000 * t) % 2 == 1 ? 1.0 : 0.0, 0}, {0, 0, 0});
  };
  for (const auto& [most, is_jointed] : {std::pair{1000, true}, {10000, false}}) {
    BOOST_TEST(tube_of({rest}, {off_at_odd}, 1e-3, most - 1, is_jointed).measured.value == 1, most);
    const Measurement all = tube_of({rest}, {off_at_odd}, 1e-3, most - 2, is_jointed).measured;
    BOOST_TEST(all.value == 0.5, boost::test_tools::tolerance(2.0 / most));
    BOOST_TEST(all.worst.time == 1e-3);
  }
}

BOOST_AUTO_TEST_SUITE_END()
