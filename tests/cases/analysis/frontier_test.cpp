#include "cases/analysis/frontier.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_frontier)

namespace {

// Runs "good" and "wild", at two steps each, in as many cases as there are errors; negative: the cell blew up.
// `errors[case][cell]`: good coarse, good fine, wild coarse, wild fine.
Results results_with(const std::vector<std::vector<double>>& errors) {
  Results results = sample_results();
  CaseResult one = results.cases.front();
  results.cases.clear();
  for (std::size_t k = 0; k < errors.size(); ++k) {
    one.definition.id = (k % 2 == 0 ? "even/case" : "odd/case") + std::to_string(k);
    for (std::size_t i = 0; i < one.cells.size(); ++i) {
      Cell cell = sample_results().cases.front().cells[0];
      cell.run = i / 2, cell.dt = one.definition.dt[i % 2];
      cell.metrics["cost"] = sample_metric(i % 2 == 0 ? 1e-3 : 4e-3, {});
      cell.metrics["position_error"].value = std::abs(errors[k][i]);
      if (errors[k][i] < 0) cell.status = Status::diverged, cell.stability.verdict = Verdict::blown_up;
      one.cells[i] = cell;
    }
    one.truth->error_at_end = 0;
    results.cases.push_back(one);
  }
  return results;
}

const FrontierPoint& point(const std::vector<Frontier>& frontiers, std::size_t run, std::size_t step) {
  BOOST_TEST_REQUIRE(frontiers.size() > run);
  BOOST_TEST_REQUIRE(frontiers[run].points.size() > step);
  return frontiers[run].points[step];
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_point_is_the_geometric_mean_of_its_cases) {
  const auto all = frontiers(results_with({{1e-2, 1e-4, 1, 1}, {1e-4, 1e-6, 1, 1}}));
  BOOST_TEST(point(all, 0, 0).mean == 1e-3, boost::test_tools::tolerance(1e-12));  // rounding of logarithms
  BOOST_TEST(point(all, 0, 1).mean == 1e-5, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(point(all, 0, 0).cases == 2u);
  BOOST_TEST(point(all, 0, 0).failed == 0u);
  BOOST_TEST(point(all, 0, 0).low == 1e-4);
  BOOST_TEST(point(all, 0, 0).high == 1e-2);
}

BOOST_AUTO_TEST_CASE(a_blow_up_is_counted_as_failed_and_makes_the_upper_percentile_infinite) {
  const auto all = frontiers(results_with({{1e-4, 1e-4, 1, 1}, {-1e-9, 1e-4, 1, 1}}));
  BOOST_TEST(point(all, 0, 0).failed == 1u);
  BOOST_TEST(point(all, 0, 0).cases == 2u);
  BOOST_TEST(std::isinf(point(all, 0, 0).high));
  BOOST_TEST(point(all, 0, 0).mean == 1e-4, boost::test_tools::tolerance(1e-12));  // its error of 1e-9 says nothing
}

BOOST_AUTO_TEST_CASE(the_method_that_blows_up_is_never_recommended) {
  // Coarse: cheap, but one of two cases blew up. Fine: within the tolerance in both.
  const Results results = results_with({{1e-4, 1e-4, 1, 1}, {-1, 1e-4, 1, 1}});
  const auto choice = cheapest_within(results, frontiers(results), 1e-3, Candidates::engines);
  BOOST_TEST_REQUIRE(choice.has_value());
  BOOST_TEST(choice->point.dt.text == results.cases[0].definition.dt[1].text);
}

BOOST_AUTO_TEST_CASE(cases_that_an_engine_cannot_run_are_counted_with_its_recommendation) {
  Results results = results_with({{1e-4, 1e-4, 1, 1}, {1e-4, 1e-4, 1, 1}, {1e-4, 1e-4, 1, 1}});
  for (Cell& cell : results.cases[1].cells)
    if (cell.run == 0) cell.status = Status::unsupported, cell.metrics.clear();
  Cell& left_out = results.cases[2].cells[0];
  left_out.status = Status::unsupported, left_out.skipped = SkipReason::another_shard, left_out.metrics.clear();
  const auto all = frontiers(results);
  BOOST_TEST(all[0].unsupported == 1u);  // the cell of another shard says nothing about the engine
  BOOST_TEST(all[1].unsupported == 0u);
  BOOST_TEST(frontiers(results, "even")[0].unsupported == 0u);
  const auto choice = cheapest_within(results, all, 1e-3, Candidates::engines);
  BOOST_TEST_REQUIRE(choice.has_value());
  BOOST_TEST(choice->unsupported == 1u);
}

BOOST_AUTO_TEST_CASE(a_step_of_few_cases_is_no_step_to_recommend) {
  // The coarse step of run 0 has 1 of 4 cases, its fine step 2: half of its own, but less than half of what run 1 has.
  Results results = results_with({{1e-4, 1e-4, 1, 1}, {1e-4, 1e-4, 1, 1}, {1e-4, 1e-4, 1, 1}, {1e-4, 1e-4, 1, 1}});
  const auto leave_out = [&](std::size_t of_case, std::size_t cell) {
    results.cases[of_case].cells[cell].status = Status::unsupported;
    results.cases[of_case].cells[cell].metrics.clear();
  };
  for (const std::size_t of_case : {1, 2, 3}) leave_out(of_case, 0);
  for (const std::size_t of_case : {2, 3}) leave_out(of_case, 1);
  const auto all = frontiers(results);
  BOOST_TEST_REQUIRE(all[0].points.size() == 1u);
  BOOST_TEST(all[0].points[0].cases == 2u);
  BOOST_TEST(all[1].points.size() == 2u);
}

BOOST_AUTO_TEST_CASE(a_few_exact_cases_do_not_hide_the_error_of_most) {
  // Two errors of 0.05 m and one of a rounding: the geometric mean is 0.1 mm, the median 0.05 m.
  const Results results = results_with({{5e-2, 1e-4, 1, 1}, {1e-14, 1e-4, 1, 1}, {5e-2, 1e-4, 1, 1}});
  const auto all = frontiers(results);
  BOOST_TEST(point(all, 0, 0).mean < 1e-3);
  BOOST_TEST(point(all, 0, 0).median == 5e-2);
  const auto choice = cheapest_within(results, all, 1e-3, Candidates::engines);
  BOOST_TEST_REQUIRE(choice.has_value());
  BOOST_TEST(choice->point.dt.text == results.cases[0].definition.dt[1].text);
}

BOOST_AUTO_TEST_CASE(nothing_is_recommended_where_no_step_is_within_the_tolerance) {
  const Results results = results_with({{1e-2, 5e-3, 1, 1}});
  BOOST_TEST(!cheapest_within(results, frontiers(results), 1e-3, Candidates::engines));
  BOOST_TEST(cheapest_within(results, frontiers(results), 1e-2, Candidates::engines).has_value());
}

BOOST_AUTO_TEST_CASE(an_engine_is_not_recommended_for_the_few_cases_that_it_can_run) {
  Results results = results_with({{1e-2, 1e-2, 1e-5, 1e-5}, {1e-2, 1e-2, 1, 1}, {1e-2, 1e-2, 1, 1}});
  for (std::size_t k = 1; k < 3; ++k)
    for (std::size_t i = 2; i < 4; ++i) results.cases[k].cells[i].status = Status::unsupported;
  const auto all = frontiers(results);
  BOOST_TEST(point(all, 1, 0).cases == 1u);
  BOOST_TEST(!cheapest_within(results, all, 1e-3, Candidates::engines));
}

BOOST_AUTO_TEST_CASE(a_family_has_a_frontier_of_its_own) {
  const Results results = results_with({{1e-2, 1e-2, 1, 1}, {1e-4, 1e-4, 1, 1}, {1e-2, 1e-2, 1, 1}});
  BOOST_TEST(point(frontiers(results, "even"), 0, 0).cases == 2u);
  BOOST_TEST(point(frontiers(results, "odd"), 0, 0).mean == 1e-4, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(frontiers(results, "ev").empty());
}

BOOST_AUTO_TEST_CASE(a_truth_made_by_the_runs_own_code_is_no_point) {
  Results results = results_with({{1e-2, 1e-2, 1, 1}});
  for (std::size_t i = 0; i < 2; ++i) results.cases[0].cells[i].metrics["position_error"].is_held_to_itself = true;
  const auto all = frontiers(results);
  BOOST_TEST_REQUIRE(all.size() == 1u);
  BOOST_TEST(all[0].run == 1u);
}

BOOST_AUTO_TEST_CASE(without_timings_the_largest_step_is_the_cheapest) {
  Results results = results_with({{1e-4, 1e-5, 1, 1}});
  for (Cell& cell : results.cases[0].cells) cell.metrics.erase("cost");
  const auto choice = cheapest_within(results, frontiers(results), 1e-3, Candidates::engines);
  BOOST_TEST_REQUIRE(choice.has_value());
  BOOST_TEST(choice->point.dt.text == results.cases[0].definition.dt[0].text);
}

BOOST_AUTO_TEST_SUITE_END()
