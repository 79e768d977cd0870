#include "cases/analysis/work_precision.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/cases/priced_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_work_precision)

namespace {

std::vector<ErrorPoint> points_of(const std::vector<test::Priced>& cells) {
  std::vector<ErrorPoint> points;
  for (const test::Priced& cell : cells) points.push_back({{cell.dt, ""}, cell.error, cell.cost});
  return points;
}

// First order: error 1e-3/cost at costs 0.01 .. 1.
const std::vector<test::Priced> kFirst = {{0.1, 0.1, 0.01}, {0.01, 0.01, 0.1}, {0.001, 0.001, 1}};
// Fourth order, twice as dear a step: error 1e-8 (0.02/cost)^4 ... at 0.1 s 1e-4.
const std::vector<test::Priced> kFourth = {{0.1, 1e-4, 0.02}, {0.01, 1e-8, 0.2}};

}  // namespace

BOOST_AUTO_TEST_CASE(between_its_cells_a_run_is_read_on_the_logarithmic_line) {
  for (const double cost : {0.02, 0.03, 0.1, 0.2}) {
    const auto at = error_at_cost(points_of(kFourth), cost, 1);
    BOOST_TEST_REQUIRE(at.has_value());
    BOOST_TEST(at->error == 1e-4 * std::pow(0.02 / cost, 4), boost::test_tools::tolerance(1e-12));
    BOOST_TEST((at->reach == Reach::interpolated));
  }
  auto reversed = points_of(kFourth);
  std::reverse(reversed.begin(), reversed.end());
  BOOST_TEST(error_at_cost(reversed, 0.1, 1)->error == 1e-4 / 625, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(beyond_its_dearest_cell_its_error_is_the_bound) {
  const auto at = error_at_cost(points_of(kFourth), 5, 1);
  BOOST_TEST(at->error == 1e-8);
  BOOST_TEST((at->reach == Reach::at_most));
}

BOOST_AUTO_TEST_CASE(below_its_cheapest_cell_it_is_extrapolated_as_far_as_longer_steps_go) {
  const auto at = error_at_cost(points_of(kFourth), 0.01, 1);
  BOOST_TEST_REQUIRE(at.has_value());
  BOOST_TEST(at->error == 1e-4 * 16, boost::test_tools::tolerance(1e-12));
  BOOST_TEST((at->reach == Reach::extrapolated));
  BOOST_TEST(!error_at_cost(points_of(kFourth), 0.01, 0.19).has_value());           // half the cost is a step of 0.2 s
  BOOST_TEST(!error_at_cost(points_of(kFourth), 0.004, 10).has_value());            // more than four times as long
  BOOST_TEST(!error_at_cost(points_of({{0.1, 1e-4, 0.02}}), 0.01, 1).has_value());  // one point has no slope
  BOOST_TEST(!error_at_cost({}, 0.01, 1).has_value());
}

BOOST_AUTO_TEST_CASE(cells_of_one_cost_are_no_trouble) {
  const auto at = error_at_cost(points_of({{0.1, 1e-3, 0.1}, {0.05, 1e-4, 0.1}}), 0.1, 1);
  BOOST_TEST_REQUIRE(at.has_value());
  BOOST_TEST(at->error == 1e-4);
  BOOST_TEST(error_at_cost(points_of({{0.1, 1e-3, 0.1}}), 0.1, 1)->error == 1e-3);
}

BOOST_AUTO_TEST_CASE(every_cell_of_a_baseline_is_compared) {
  const Results results = test::priced_results({{"core", kFourth}, {"ode", kFirst}});
  BOOST_TEST((baselines(results) == std::vector<std::size_t>{1}));
  const auto points = at_equal_cost(results.cases.front(), 0, 1, "position_error");
  BOOST_TEST_REQUIRE(points.size() == 3u);
  // At .01 s/s a step of .2 s: 1.6e-3 against .1; at .1 s/s 1.6e-7 against .01; above .2 s/s at most 1e-8.
  BOOST_TEST(points[0].times_less() == 0.1 / 1.6e-3, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(points[1].times_less() == 0.01 / 1.6e-7, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(points[2].times_less() == 0.001 / 1e-8, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(the_best_of_the_core_is_compared_with_most_cells_and_gains_most_in_the_mean) {
  const Results results = test::priced_results({{"core", kFourth}, {"ode", kFirst}});
  const auto best = best_of_core(results, results.cases.front(), 1, "position_error");
  BOOST_TEST_REQUIRE(best.has_value());
  BOOST_TEST(best->compared() == 3u);
  BOOST_TEST(best->least() == 62.5, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(best->mean() == std::cbrt(62.5 * 62500 * 1e5), boost::test_tools::tolerance(1e-9));
  Results without = results;
  for (Cell& cell : without.cases.front().cells) {
    if (cell.run == 0) cell.status = Status::diverged;
  }
  BOOST_TEST(!best_of_core(without, without.cases.front(), 1, "position_error").has_value());
}

BOOST_AUTO_TEST_SUITE_END()
