#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <sstream>

#include "cases/report/json/leave_out_details.h"
#include "cases/report/markdown/said_before.h"
#include "cases/report/reports.h"
#include "cases/report/wording/verdict_matrix.h"
#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_markdown_markdown_report)

BOOST_AUTO_TEST_CASE(every_row_has_the_columns_of_its_header_whatever_a_name_holds) {
  std::istringstream lines(markdown_report(sample_results()));
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("|")) continue;
    ++rows;
    int bars = 0;
    for (std::size_t i = 0; i < line.size(); ++i) bars += line[i] == '|' && (i == 0 || line[i - 1] != '\\');
    BOOST_TEST(bars == (rows <= 3 ? 4 : 9), line);
  }
  // The matrix: a header, its rule and the only case. Two step sizes: a header, its rule and two engines each; then the
  // same for the error explained, of which the engine that crashed has none.
  BOOST_TEST(rows == 3 + 15);
}

BOOST_AUTO_TEST_CASE(of_many_cases_there_is_the_matrix_alone) {
  Results grid = sample_results();
  while (grid.cases.size() <= kMostCasesInDetail) grid.cases.push_back(grid.cases.front());
  const std::string text = markdown_report(grid);
  BOOST_TEST(text.find("| family/case |") != std::string::npos);
  BOOST_TEST(text.find("| dt = 1/10 s |") == std::string::npos);
  BOOST_TEST(text.find("rigor run CASE") != std::string::npos);
}

// If not all runs fit side by side, the matrix shows the first of each engine. Others are listed only where they differ
// from it.
BOOST_AUTO_TEST_CASE(an_engines_other_runs_are_told_by_what_they_set_apart) {
  Results grid = sample_results();
  CaseResult& alike = grid.cases.front();
  alike.definition.id = "family/alike";
  const auto add_run = [&](const std::string& name) {
    grid.runs.push_back(grid.runs[0]);
    grid.runs.back().text = name;
    alike.stable_steps.push_back(alike.stable_steps[0]);
    Cell cell = alike.cells[0];
    cell.run = grid.runs.size() - 1;
    alike.cells.push_back(cell);
  };
  for (std::size_t i = grid.runs.size(); i <= kMostMatrixColumns; ++i) add_run("good,option=" + std::to_string(i));
  BOOST_TEST(markdown_report(grid).find("good: 6 runs beside good, which all end as it does") != std::string::npos);
  CaseResult apart = alike;
  apart.definition.id = "family/apart";
  apart.cells.back().metrics["position_error"].value = 0.125;
  grid.cases.push_back(apart);
  const std::string text = markdown_report(grid), open = "<summary>good: 6 runs beside good</summary>";
  const std::size_t begin = text.find(open), end = text.find("</details>", begin);
  BOOST_TEST_REQUIRE(begin != std::string::npos, text);
  const std::string table = text.substr(begin, end - begin);
  BOOST_TEST(table.find("alike") == std::string::npos, table);
  BOOST_TEST(table.find("| family/apart | = | = | = | = | = | ✓ stable 0.125 m") != std::string::npos, table);
  BOOST_TEST(text.find("runs beside wild") == std::string::npos);  // it has no other
}

// A gate's reason, and why a deviation is known, stand once for all runs that they hold for.
BOOST_AUTO_TEST_CASE(of_many_cases_known_deviations_of_one_reason_are_a_line) {
  Results grid = sample_results();
  CaseResult& first = grid.cases.front();
  first.definition.gates.resize(1);
  first.definition.gates[0].metric = "position_error";
  for (const char* engine : {"good", "wild"}) {
    first.gates.push_back(
        {0, engine, "1/10", GateAnswer::known_deviation,
         std::string("position_error of ") + engine + " is 3 m (the gate: half a metre) (known: soft)"});
  }
  BOOST_TEST(markdown_report(grid).find("of wild is 3 m") != std::string::npos);
  while (grid.cases.size() <= kMostCasesInDetail) grid.cases.push_back(sample_results().cases.front());
  const std::string line =
      "- known deviation: position\\_error of good at dt = 1/10, position\\_error of wild at dt = 1/10 "
      "(the gate: half a metre) (known: soft)\n";
  BOOST_TEST(markdown_report(grid).find(line) != std::string::npos);
}

BOOST_AUTO_TEST_CASE(what_ends_in_the_words_of_an_earlier_paragraph_is_cut_there) {
  SaidBefore said;
  const std::string reason = "its setting gives back a fifth of every overlap as speed, which stays.";
  BOOST_TEST(said.shortened("A bounces: " + reason) == "A bounces: " + reason);
  BOOST_TEST(said.shortened("B bounces by 3 m: " + reason) == "B bounces by 3 m: …");
  BOOST_TEST(said.shortened("B bounces: " + reason + " And on.") == "B bounces: " + reason + " And on.");
  BOOST_TEST(said.shortened("C (too little) (short)") == "C (too little) (short)");
  BOOST_TEST(said.shortened("D (too little) (short)") == "D (too little) (short)");
}

// The second run is told by what it sets apart; where nothing is alike, in full.
BOOST_AUTO_TEST_CASE(settings_are_told_beside_those_of_a_run_before) {
  Results grid = sample_results();
  grid.cases.front().cells[0].settings = {{"solver", "exact"}, {"friction", "a cone"}, {"sub-steps", "none at all"}};
  grid.cases.front().cells[1].settings.clear();
  grid.cases.front().cells[2].settings = {{"solver", "rough"}, {"friction", "a cone"}, {"sub-steps", "none at all"}};
  BOOST_TEST(markdown_report(grid).find("- wild: as good, but solver = rough;\n") != std::string::npos);
  grid.cases.front().cells[2].settings = {{"method", "rough"}, {"friction", "a cone"}, {"sub-steps", "none at all"}};
  BOOST_TEST(markdown_report(grid).find("- wild: method = rough; friction = a cone;") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(no_name_becomes_a_tag) {
  const std::string text = markdown_report(sample_results());
  BOOST_TEST(text.find("<b>") == std::string::npos);
  BOOST_TEST(text.find("<i>") == std::string::npos);
  BOOST_TEST(text.find("&lt;b>") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_coarsest_step_comes_first_and_the_settings_are_told) {
  const std::string text = markdown_report(sample_results());
  BOOST_TEST(text.find("dt = 1/10") < text.find("dt = 1/20"));
  BOOST_TEST(text.find("solver = exact") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
