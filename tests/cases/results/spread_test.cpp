#include "cases/results/spread.h"

#include <boost/test/unit_test.hpp>

#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_results_spread)

namespace {

// Body 0 rests; body 1 moves along x at `speed` and turns about z at `spin`.
Trajectory moving(double speed, double spin, int steps, double dt = 0.25) {
  Trajectory trajectory{dt, {}};
  for (int n = 0; n <= steps; ++n) {
    BodyTable bodies(2);
    const double t = n * dt;
    bodies.columns().set_body(0, {});
    bodies.columns().set_body(1, {{speed * t, 1, 2}, rotation_by({0, 0, spin * t}), Vec3::Zero(), Vec3::Zero()});
    trajectory.samples.push_back({t, bodies});
  }
  return trajectory;
}

Spread spread_of(const Trajectory& a, const Trajectory& b) {
  return spread_between(path_of(a, 2, 2), path_of(b, 2, 2));
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_spread_is_the_largest_distance_and_angle_with_their_body_and_time) {
  const Spread spread = spread_of(moving(1, 0.25, 8), moving(1.5, -0.5, 8));
  BOOST_TEST(spread.distance.value == 1, boost::test_tools::tolerance(1e-12));  // 0.5 m/s over 2 s
  BOOST_TEST(spread.angle.value == 1.5, boost::test_tools::tolerance(1e-12));   // 0.75 rad/s
  for (const Furthest& furthest : {spread.distance, spread.angle}) {
    BOOST_TEST(furthest.time == 2);
    BOOST_TEST(furthest.body == 1);
  }
  BOOST_TEST(spread.compared_until == 2);
}

BOOST_AUTO_TEST_CASE(they_part_at_the_first_instant_beyond_either_tolerance) {
  struct Row {
    double speed, spin;
    std::optional<double> parted_at;
  };
  for (const Row& row : {Row{0, 0, {}}, Row{0.49e-3, 0, {}},  // 0.98 mm at the end
                         Row{1.5e-3, 0, 0.75},                // 1.125 mm there
                         Row{0, 0.015, 0.75},                 // 0.01125 rad there
                         Row{1.5e-3, 0.03, 0.5}}) {           // the angle first, 0.015 rad
    const Spread spread = spread_of(moving(0, 0, 8), moving(row.speed, row.spin, 8));
    BOOST_TEST_CONTEXT(row.speed << " m/s, " << row.spin << " rad/s") BOOST_TEST((spread.parted_at == row.parted_at));
  }
}

BOOST_AUTO_TEST_CASE(bytes_that_are_no_path_are_refused) {
  const std::string good = packed(path_of(moving(1, 0, 3), 2, 2));
  BOOST_TEST(packed(unpacked(good)) == good);
  for (std::size_t size = 0; size < good.size(); ++size)
    BOOST_CHECK_THROW(unpacked(good.substr(0, size)), std::runtime_error);
  BOOST_CHECK_THROW(unpacked(good + "x"), std::runtime_error);
  for (const std::size_t byte : {0, 7, 8, 15}) {  // of either count, the lowest and the highest
    std::string garbled = good;
    garbled[byte] = '\x7f';
    BOOST_CHECK_THROW(unpacked(garbled), std::runtime_error);
  }
}

BOOST_AUTO_TEST_CASE(a_run_that_ended_early_is_compared_until_then) {
  const Spread spread = spread_of(moving(0, 0, 3), moving(1, 0, 8));
  BOOST_TEST(spread.compared_until == 0.75);
  BOOST_TEST(spread.distance.value == 0.75);
  const Spread other_way = spread_of(moving(1, 0, 8), moving(0, 0, 3));
  BOOST_TEST(other_way.compared_until == 0.75);
  BOOST_TEST(other_way.distance.value == 0.75);
  BOOST_TEST(spread_of(moving(1, 0, 8), {0.25, {}}).compared_until == 0);
  const Spread nothing = spread_of({0.25, {}}, moving(1, 0, 8));
  BOOST_TEST(nothing.compared_until == 0);
  BOOST_TEST(!nothing.parted_at.has_value());
}

BOOST_AUTO_TEST_CASE(a_path_is_small_however_long_the_run_and_shares_its_instants_with_others) {
  const int steps = 50'000;
  const Trajectory whole = moving(1, 0, steps, 1e-3), cut = moving(1, 0, steps / 3, 1e-3);
  const Path path = path_of(whole, 50, 2), shorter = path_of(cut, 50, 2);
  BOOST_TEST(static_cast<double>(packed(path).size()) < kLargestPath + 1000);
  BOOST_TEST(path.times.size() > 1000u);
  BOOST_TEST_REQUIRE(shorter.times.size() > 300u);
  for (std::size_t i = 0; i < shorter.times.size(); ++i) BOOST_TEST(shorter.times[i] == path.times[i]);
}

BOOST_AUTO_TEST_CASE(a_path_comes_out_of_the_pipe_as_it_went_in) {
  for (const Path& path : {path_of(moving(1, 2, 7), 2, 2), path_of({0.25, {}}, 2, 2)}) {
    const Path back = unpacked(packed(path));
    BOOST_TEST(back.bodies == path.bodies);
    BOOST_TEST((back.times == path.times));
    BOOST_TEST((back.poses == path.poses));
  }
}

BOOST_AUTO_TEST_SUITE_END()
