#include "cases/analysis/step_needed.h"

#include <boost/test/unit_test.hpp>

#include "cases/analysis/relative_error.h"
#include "tests/cases/priced_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_step_needed)

namespace {

constexpr double kMillimetre = 1e-3;
const auto kRounding = boost::test_tools::tolerance(1e-12);

StepNeeded of(const std::vector<test::Priced>& cells) {
  const Results grid = test::priced_results({{"run", cells}});
  return step_needed(grid.cases[0], 0, "position_error", kMillimetre).value();
}

Results with_failed(std::vector<test::Priced> cells, std::size_t failed) {
  Results grid = test::priced_results({{"run", std::move(cells)}});
  Cell& cell = grid.cases[0].cells[failed];
  cell.status = Status::diverged, cell.stability = {Verdict::blown_up, 0.1, 0, ""};
  return grid;
}

// Cases of one step of 0.1 s; each a row of errors by run, negative for a blow-up.
Results cases_of(const std::vector<std::string>& runs, const std::vector<std::vector<double>>& errors) {
  Results grid;
  for (const std::vector<double>& row : errors) {
    std::vector<std::pair<std::string, std::vector<test::Priced>>> cells;
    for (std::size_t run = 0; run < runs.size(); ++run) cells.push_back({runs[run], {{0.1, std::abs(row[run]), 1}}});
    Results one = test::priced_results(cells);
    for (std::size_t run = 0; run < runs.size(); ++run) {
      if (row[run] >= 0) continue;
      one.cases[0].cells[run].status = Status::diverged;
      one.cases[0].cells[run].stability = {Verdict::blown_up, 0.1, 0, ""};
    }
    one.cases[0].definition.id = "case" + std::to_string(grid.cases.size());
    if (grid.cases.empty()) grid.runs = one.runs, grid.engines = one.engines;
    grid.cases.push_back(one.cases[0]);
  }
  return grid;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_is_tried_between_beyond_or_none) {
  using enum StepNeeded::Found;
  BOOST_TEST((of({{0.1, 5e-4, 1}, {0.05, 1e-4, 1}}).found == tried));
  BOOST_TEST(of({{0.1, 5e-4, 1}}).is_coarsest);
  const StepNeeded between_two = of({{0.1, 4e-3, 1}, {0.05, 0.25e-3, 1}});  // fourth order
  BOOST_TEST((between_two.found == between));
  BOOST_TEST(between_two.seconds == 0.1 / std::pow(4, 0.25), kRounding);
  const StepNeeded beyond_both = of({{0.1, 4e-3, 1}, {0.05, 2e-3, 1}});  // first order
  BOOST_TEST((beyond_both.found == beyond));
  BOOST_TEST(beyond_both.seconds == 0.025, kRounding);
  BOOST_TEST((of({{0.1, 4e-3, 1}, {0.05, 4e-3, 1}}).found == none));    // does not fall
  BOOST_TEST((of({{0.1, 0.128, 1}, {0.05, 0.064, 1}}).found == none));  // 64 steps below: too far
  BOOST_TEST((of({{0.1, 2e-3, 1}}).found == none));                     // one step shows no order
}

// A coarse step that is right by chance is not what a tolerance takes.
BOOST_AUTO_TEST_CASE(every_finer_step_must_keep_the_tolerance) {
  const StepNeeded found = of({{0.1, 5e-4, 1}, {0.05, 5e-3, 1}, {0.01, 5e-4, 1}});
  BOOST_TEST(found.seconds < 0.05);
  BOOST_TEST(found.seconds >= 0.01);
}

BOOST_AUTO_TEST_CASE(a_blow_up_keeps_no_tolerance) {
  const std::vector<test::Priced> cells = {{0.1, 5e-4, 1}, {0.05, 1e-4, 1}};
  const StepNeeded coarse = step_needed(with_failed(cells, 0).cases[0], 0, "position_error", kMillimetre).value();
  BOOST_TEST((coarse.found == StepNeeded::Found::tried));
  BOOST_TEST(coarse.seconds == 0.05);
  BOOST_TEST(!coarse.is_coarsest);
  const StepNeeded fine = step_needed(with_failed(cells, 1).cases[0], 0, "position_error", kMillimetre).value();
  BOOST_TEST((fine.found == StepNeeded::Found::none));
}

BOOST_AUTO_TEST_CASE(the_median_of_an_even_count_is_the_worse_and_a_blow_up_counts_as_no_step) {
  const auto both = steps_over_cases(cases_of({"half", "whole"}, {{-1, 1e-4}, {1e-4, 1e-4}}), kMillimetre);
  BOOST_TEST_REQUIRE(both.size() == 2u);
  BOOST_TEST(both[0].cases == 2u);
  BOOST_TEST(both[0].failed == 1u);
  BOOST_TEST((both[0].median.found == StepNeeded::Found::none));
  BOOST_TEST(both[1].median.seconds == 0.1);
}

BOOST_AUTO_TEST_CASE(errors_are_held_beside_the_median_run_and_a_blow_up_is_worse_than_any) {
  const Results grid = cases_of({"a", "b", "c", "d"}, {{1e-3, 2e-3, 4e-3, -1}, {1e-3, 2e-3, 4e-3, 8e-3}});
  const auto found = relative_errors(grid, {0.1, "0.1"});
  BOOST_TEST_REQUIRE(found.size() == 4u);
  // Of four the third is the median, 4e-3 m, in both cases; a's ratio is 1/4 in both.
  BOOST_TEST(found[0].ratio == 0.25, kRounding);
  BOOST_TEST(found[2].ratio == 1, kRounding);
  BOOST_TEST(std::isinf(found[3].ratio));  // one of two cases: the worse half
  BOOST_TEST(found[3].failed == 1u);
}

BOOST_AUTO_TEST_SUITE_END()
