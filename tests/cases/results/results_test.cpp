#include "cases/results/results.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_results_results)

namespace {

// At 0, 0.25, ... s.
Trajectory samples(std::size_t count) {
  Trajectory trajectory{0.25, {}};
  for (std::size_t n = 0; n < count; ++n) trajectory.samples.push_back({0.25 * static_cast<double>(n), BodyTable(1)});
  return trajectory;
}

MetricValue condensed_series(const std::vector<double>& series) {
  MetricResult result;
  result.measurement.emplace();
  result.measurement->value = 7, result.measurement->compared_until = 3, result.measurement->series = series;
  result.measurement->worst = {0.5, 0, "position.x", 1, 2};
  return condensed(result, samples(8));
}

}  // namespace

// The fifth sample is at 1 s, and counts.
BOOST_AUTO_TEST_CASE(of_a_series_the_largest_of_its_first_second_is_kept) {
  const MetricValue value = condensed_series({0, 1, -2, 1, 1, 9});
  BOOST_TEST((value.value == 7 && value.compared_until == 3 && value.worst.component == "position.x"));
  BOOST_TEST(value.first_second == -2);
  BOOST_TEST(condensed_series({0, 1, -2, 1, 3, 9}).first_second == 3);
  BOOST_TEST(condensed_series({0, 1}).first_second == 1);  // shorter than a second
  BOOST_TEST(std::isnan(condensed_series({}).first_second));
  const MetricValue none = condensed({{}, "there is no truth"}, samples(8));
  BOOST_TEST((none.not_applicable == "there is no truth" && none.value == 0));
}

BOOST_AUTO_TEST_CASE(some_answers_are_failures_and_others_are_not) {
  using enum GateAnswer;
  for (const GateAnswer answer : {failed, not_checked, unexpected_pass})
    BOOST_TEST(is_failure(answer), word_of(answer));
  for (const GateAnswer answer : {held, known_deviation, not_recorded})
    BOOST_TEST(!is_failure(answer), word_of(answer));
}

BOOST_AUTO_TEST_CASE(the_headline_is_the_coarsest_step_and_a_run_is_in_house_as_its_engine_is) {
  Results grid = sample_results();
  std::swap(grid.cases.front().definition.dt.front(), grid.cases.front().definition.dt.back());
  BOOST_TEST(coarsest_dt(grid.cases.front()).text == "1/10");
  for (const bool first : {true, false}) {
    grid.engines[0].is_in_house = first, grid.engines[1].is_in_house = !first;
    BOOST_TEST((is_in_house(grid, 0) == first && is_in_house(grid, 1) == !first));
  }
}

BOOST_AUTO_TEST_SUITE_END()
