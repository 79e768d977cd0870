#include "cases/report/github/job_summary.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>

#include "cases/gates/gates.h"
#include "tests/cases/limit_as.h"
#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_github_job_summary)

namespace {

Results failing_results() {
  Results grid = sample_results();
  CaseResult& result = grid.cases.front();
  Gate limit;
  limit.metric = "position_error", test::limit_as<BoundLimit>(limit).max = 0.125,
  limit.because = "an eighth, by the formula: x % y";
  limit.where = "suite/a, b.toml:7:3";
  result.definition.gates = {limit};
  check_gates(result, grid);
  return grid;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_row_has_the_worst_instant_and_both_values_and_the_reason) {
  const auto rows = failures(failing_results());
  // Two cells of "good"; of "wild" the one that blew up, and the one that crashed twice: as a cell and for its gate.
  BOOST_TEST_REQUIRE(rows.size() == 5u);
  const auto good = std::find_if(rows.begin(), rows.end(), [](const Failure& row) { return row.engine == "good"; });
  BOOST_TEST(good->what == "position_error");
  BOOST_TEST(good->found == "0.25 m");
  BOOST_TEST(good->limit == "at most 0.125 m");
  BOOST_TEST(good->worst == "at 0.3 s: st|one \"1\", <i>, position.y: found 2, expected 1.75");
  BOOST_TEST(good->because == "an eighth, by the formula: x % y");
}

BOOST_AUTO_TEST_CASE(the_summary_is_a_table_whatever_a_name_holds) {
  const std::string text = job_summary(failing_results());
  BOOST_TEST(text.find("<i>") == std::string::npos);
  BOOST_TEST(text.find("found 2, expected 1.75") != std::string::npos);
  BOOST_TEST(text.find("gates fell short") != std::string::npos);
  BOOST_TEST(text.find("| family/case | 0 | 4 | 0 |") != std::string::npos, text);
}

BOOST_AUTO_TEST_CASE(a_long_summary_is_cut_between_rows_and_says_so) {
  Results grid = failing_results();
  const CaseResult one = grid.cases.front();
  for (int i = 0; i < 1000; ++i) grid.cases.push_back(one);
  const std::string text = job_summary(grid, 50000);
  BOOST_TEST(text.size() <= 50100u);  // the row that says how many more there are
  BOOST_TEST(text.size() > 40000u);
  BOOST_TEST(text.find(" more are in results.json") != std::string::npos);
  BOOST_TEST(job_summary(grid).size() < 1000000u);
}

BOOST_AUTO_TEST_CASE(an_annotation_points_at_the_gate_in_its_file) {
  const std::string text = annotations(failures(failing_results()));
  BOOST_TEST(std::count(text.begin(), text.end(), '\n') == 5);
  BOOST_TEST(text.find("::error file=suite/a%2C b.toml,line=7,col=3,title=family/case%3A position_error::good at dt = "
                       "1/10: found 0.25 m, wanted at most 0.125 m; worst at 0.3 s") != std::string::npos,
             text);
  BOOST_TEST(text.find("x %25 y") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(nothing_is_said_of_gates_that_hold) {
  Results grid = failing_results();
  grid.cases.front().cells.erase(grid.cases.front().cells.begin() + 2, grid.cases.front().cells.end());
  test::limit_as<BoundLimit>(grid.cases.front().definition.gates.front()).max = 1;
  check_gates(grid.cases.front(), grid);
  BOOST_TEST(failures(grid).empty());
  BOOST_TEST(failures(grid).empty());
  BOOST_TEST(annotations(failures(grid)).empty());
  BOOST_TEST(job_summary(grid).find("all gates hold") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
