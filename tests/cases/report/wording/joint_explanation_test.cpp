// What is said of joints that do not hold, and that nothing is said of those that do.
#include "cases/report/wording/explanations/joint_explanation.h"

#include <boost/test/unit_test.hpp>

#include "cases/report/wording/findings/findings.h"
#include "tests/cases/report/jointed_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_joint_explanation)

namespace {

std::vector<std::string> said_of(const Results& grid) {
  std::vector<std::string> said;
  for (const Message& message : joint_explanations(grid, grid.cases.front())) said.push_back(message.text);
  return said;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string joints_found(const Results& grid) {
  for (const Finding& finding : findings(grid)) {
    if (finding.topic == "joints") return finding.text;
  }
  return "";
}

}  // namespace

// A slider-crank whose rod is longer than its crank has no singular position. One step of 1/30 s took it for one.
BOOST_AUTO_TEST_CASE(a_singular_position_is_told_only_where_the_finest_step_reports_it) {
  Results grid = test::jointed_results(test::chain_of(2, 1));
  std::vector<Cell*> cells;
  for (Cell& cell : grid.cases[0].cells) {
    if (cell.run == 0) cells.push_back(&cell), cell.metrics["cost"] = MetricValue();
  }
  std::sort(cells.begin(), cells.end(), [](const Cell* a, const Cell* b) { return a->dt.seconds > b->dt.seconds; });
  BOOST_TEST_REQUIRE(cells.size() > 1u);
  cells.front()->settings.emplace_back("singular positions", "at 0.5291 s");
  BOOST_TEST(said_of(grid).empty());
  cells.back()->settings.emplace_back("singular positions", "at 0.5 s");
  BOOST_TEST_REQUIRE(said_of(grid).size() == 1u);
  BOOST_TEST(has(said_of(grid)[0], "at 0.5 s"), said_of(grid)[0]);
}

// Every step opens the joint by ½ a dt²; at a share of 0.2 five of these stand.
BOOST_AUTO_TEST_CASE(a_gap_that_stands_is_told_with_what_a_step_opens) {
  Results grid = test::jointed_results(test::chain_of(2, 1));
  BOOST_TEST(said_of(grid).empty());
  for (const std::size_t run : {0, 1}) test::set_setting(grid, run, "erp", "0.2: that share of a gap");
  const double ratio = test::coarse_over_fine(grid);
  for (const std::size_t run : {0, 1}) test::set_gaps(grid, run, {0.01, 0.01 / ratio});
  BOOST_REQUIRE(said_of(grid).size() == 1);
  BOOST_TEST(!has(said_of(grid)[0], "add up"));  // no gap that stands falls by its first power
  for (const std::size_t run : {0, 1}) test::set_gaps(grid, run, {0.01, 0.01 / ratio / ratio});
  const auto said = said_of(grid);
  BOOST_REQUIRE(said.size() == 1);  // of both at once
  BOOST_TEST(has(said[0], "joints of good, wild come apart"));
  BOOST_TEST(has(said[0], "the ball of 'world' and 'link0'"));
  BOOST_TEST(has(said[0], "Each step closes 20 % of a gap, so 5 openings of 2 mm add up."));
  BOOST_TEST(has(said[0], "that share of a gap."));
}

BOOST_AUTO_TEST_CASE(a_gap_that_grows_stands_nowhere) {
  Results grid = test::jointed_results(test::chain_of(2, 1));
  test::set_gaps(grid, 0, {0.01, 0.0025}), test::set_setting(grid, 0, "erp", "0.2");
  grid.cases[0].cells[0].metrics["joint_gap"].first_second = 0.001;
  const auto said = said_of(grid);
  BOOST_REQUIRE(said.size() == 1);
  BOOST_TEST(has(said[0], "grows with time: 1 mm within the first second"));
  BOOST_TEST(!has(said[0], "add up"));
}

BOOST_AUTO_TEST_CASE(a_stretched_chain_is_told_with_its_sweeps_joints_and_masses) {
  Results grid = test::jointed_results(test::chain_of(8, 40));
  grid.runs[1].engine = grid.runs[0].engine;
  test::set_gaps(grid, 0, {0.3, 0.2}), test::set_setting(grid, 0, "iterations", "20");
  test::set_gaps(grid, 1, {0.02, 0.01});
  const auto said = said_of(grid);
  BOOST_REQUIRE(said.size() == 1);
  for (const char* part : {"the sweeps of good from joint to joint stretch 8 joints in a row by 300 mm",
                           "wild leaves 20 mm", "Masses up to 40 : 1 slow it down further.", "\"iterations\": 20."})
    BOOST_TEST_CONTEXT(said[0]) BOOST_TEST(has(said[0], part));
}

BOOST_AUTO_TEST_CASE(the_first_screen_says_whose_joints_hold) {
  Results grid = test::jointed_results(test::chain_of(2, 1));
  BOOST_TEST(joints_found(grid) == "");  // nothing was measured
  test::set_gaps(grid, 0, {1e-9, 1e-9}), test::set_gaps(grid, 1, {0.05, 0.01});
  const std::string text = joints_found(grid);
  BOOST_TEST(has(text, "They hold to a millionth of their size: good."));
  BOOST_TEST(has(text, "They come apart: wild 50 mm of 500 mm (family/case)."));
  for (Cell& cell : grid.cases[0].cells) cell.stability.verdict = Verdict::blown_up;
  BOOST_TEST(joints_found(grid) == "");  // what blew up is told elsewhere
}

BOOST_AUTO_TEST_SUITE_END()
