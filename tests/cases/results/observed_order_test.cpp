#include "cases/results/observed_order.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/cases/priced_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_results_observed_order)

namespace {

// c dt^p at a run's steps.
std::vector<test::Priced> power(double c, double p, const std::vector<double>& steps) {
  std::vector<test::Priced> cells;
  for (const double dt : steps) cells.push_back({dt, c * std::pow(dt, p), 1e-6 / dt});
  return cells;
}

double order_of(const Results& results, std::size_t run = 0) {
  const ObservedOrder order = observed_order(results.cases.front(), run, "position_error");
  BOOST_TEST_REQUIRE(order.value.has_value(), order.text);
  return *order.value;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_order_is_the_power_of_dt_at_any_number_of_steps) {
  for (const double p : {1.0, 2.0, 4.0}) {
    for (const auto& steps : {std::vector{0.1, 0.05}, {0.1, 0.03, 0.01, 0.003, 0.001}}) {
      BOOST_TEST(order_of(test::priced_results({{"a", power(3, p, steps)}})) == p, boost::test_tools::tolerance(1e-12));
    }
  }
}

BOOST_AUTO_TEST_CASE(three_points_off_the_line_have_the_slope_of_least_squares) {
  // At log2 dt = 0, -1, -2 and log2 error = 0, -3, -4: the slope between the ends.
  const Results results = test::priced_results({{"a", {{1, 1, 1}, {0.5, 0.125, 2}, {0.25, 0.0625, 4}}}});
  BOOST_TEST(order_of(results) == 2, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(errors_at_the_floor_and_cells_that_blew_up_show_no_order) {
  auto cells = power(1, 4, {0.1, 0.05, 0.01});
  cells.push_back({0.001, 3e-12, 1e-3});  // the truth is sure of 1e-12: not the scheme's
  Results results = test::priced_results({{"a", cells}});
  BOOST_TEST(order_of(results) == 4, boost::test_tools::tolerance(1e-12));
  results.cases.front().cells[0].metrics["position_error"].value = 100;
  results.cases.front().cells[0].status = Status::diverged;
  BOOST_TEST(order_of(results) == 4, boost::test_tools::tolerance(1e-12));
  results.cases.front().cells[1].status = Status::crashed;
  const ObservedOrder none = observed_order(results.cases.front(), 0, "position_error");
  BOOST_TEST(!none.value.has_value());
  BOOST_TEST(!none.text.empty());
}

// Steps are timed only for a gate on the cost, as in a gate's run.
BOOST_AUTO_TEST_CASE(an_order_needs_no_costs_and_work_precision_does) {
  Results results = test::priced_results({{"a", power(3, 2, {0.1, 0.05})}});
  for (Cell& cell : results.cases.front().cells) {
    cell.metrics["cost"].value = 0;
    cell.metrics["cost"].not_applicable = "the run's steps were not timed";
  }
  BOOST_TEST(order_of(results) == 2, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(error_points(results.cases.front(), 0, "position_error").empty());
}

// A hundred times what the truth is sure of is where a scheme's own error begins.
BOOST_AUTO_TEST_CASE(an_error_up_to_a_hundred_times_the_floor_is_none_of_the_schemes) {
  const auto is_fitted = [](double of_floor) {
    Results results = test::priced_results({{"a", {{0.2, 1e-3, 1}, {0.1, of_floor * 0x1p-30, 2}}}});
    results.cases.front().truth->error_at_end = 0x1p-30;
    return observed_order(results.cases.front(), 0, "position_error").value.has_value();
  };
  BOOST_TEST(!is_fitted(100));
  BOOST_TEST(is_fitted(100.5));
}

BOOST_AUTO_TEST_CASE(a_run_that_is_held_to_itself_or_has_no_number_has_no_points) {
  Results results = test::priced_results({{"a", power(3, 2, {0.1, 0.05})}, {"b", power(3, 2, {0.1, 0.05})}});
  CaseResult& result = results.cases.front();
  const auto points = [&](std::size_t run) { return error_points(result, run, "position_error").size(); };
  BOOST_TEST((points(0) == 2u && points(1) == 2u));
  result.cells[0].metrics["position_error"].is_held_to_itself = true;
  BOOST_TEST((points(0) == 0u && points(1) == 2u));
  result.cells[0].metrics["position_error"].is_held_to_itself = false;
  result.cells[0].metrics["position_error"].value = std::nan("");
  BOOST_TEST(points(0) == 1u);
  for (const Status status : {Status::fail, Status::known_deviation, Status::unexpected_pass, Status::timed_out}) {
    result.cells[1].status = status;
    BOOST_TEST(points(0) == (status == Status::timed_out ? 0u : 1u), word_of(status));
  }
}

BOOST_AUTO_TEST_CASE(only_the_steps_asked_for_are_fitted) {
  const Results results = test::priced_results({{"a", {{0.4, 100, 1}, {0.2, 0.2, 2}, {0.1, 0.1, 4}}}});
  const auto fine = [](const StepSize& dt) { return dt.seconds < 0.3; };
  BOOST_TEST(*observed_order(results.cases.front(), 0, "position_error", fine).value == 1,
             boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(an_error_is_worth_comparing_if_some_run_has_one) {
  const auto worth = [](double error, const char* metric) {
    return errors_worth_comparing(
        test::priced_results({{"a", {{0.1, 0, 1}}}, {"b", {{0.1, error, 1}}}}, metric).cases.front());
  };
  BOOST_TEST((worth(0.1, "position_error") == std::vector<std::string>{"position_error"}));
  BOOST_TEST((worth(0.1, "orientation_error") == std::vector<std::string>{"orientation_error"}));
  BOOST_TEST(worth(1e-12, "position_error").empty());
}

BOOST_AUTO_TEST_CASE(no_error_is_taken_to_be_below_what_the_truth_is_sure_of) {
  Results results = test::priced_results({{"a", {{0.1, 1e-15, 1}, {0.05, 1e-9, 2}}}});
  const auto points = error_points(results.cases.front(), 0, "position_error");
  BOOST_TEST_REQUIRE(points.size() == 2u);
  BOOST_TEST(points[0].error == 1e-12);
  BOOST_TEST(points[1].error == 1e-9);
  results.cases.front().truth->error_at_end = 10;  // beyond its horizon, where nothing is compared
  BOOST_TEST(error_floor(results.cases.front()) == 1e-6);
}

BOOST_AUTO_TEST_SUITE_END()
