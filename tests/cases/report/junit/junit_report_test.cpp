#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <regex>

#include "cases/gates/gates.h"
#include "cases/report/reports.h"
#include "generated/tests/places.h"
#include "tests/cases/limit_as.h"
#include "tests/cases/report/sample_results.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_junit_junit_report)

namespace {

// The sample's grid. One gate holds for one cell, fails for a blown-up one and meets a crashed one. A second is a known
// deviation, and a third meets no cell.
Results gated_results() {
  Results grid = sample_results();
  CaseResult& result = grid.cases.front();
  Gate limit, known, unmet;
  limit.metric = "position_error", test::limit_as<BoundLimit>(limit).max = 0.5,
  limit.because = "half a metre, \x01 & no more", limit.where = "c:7:1";
  known.metric = "energy_drift", test::limit_as<BoundLimit>(known).max = 0.1, known.engines = {"good"};
  unmet.metric = "orientation_error", test::limit_as<BoundLimit>(unmet).max = 1, unmet.engines = {"good"};
  result.definition.gates = {limit, known, unmet};
  check_gates(result, grid);
  for (GateResult& answer : result.gates) {
    if (answer.gate == 1) answer.answer = GateAnswer::known_deviation;
  }
  for (Cell& cell : result.cells) cell.wall_seconds = 0.25;
  return grid;
}

long count(const std::string& text, const std::string& pattern) {
  const std::regex wanted(pattern);
  return std::distance(std::sregex_iterator(text.begin(), text.end(), wanted), std::sregex_iterator());
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_is_what_the_schema_says) {
  const Folder folder;
  const std::string file = folder.write("junit.xml", junit_report(gated_results()));
  const std::string command =
      "xmllint --noout --schema " RIGOR_SOURCE_DIR "/tests/cases/report/junit/junit.xsd " + file + " 2>&1";
  BOOST_TEST(std::system(command.c_str()) == 0, junit_report(gated_results()));
}

BOOST_AUTO_TEST_CASE(characters_that_xml_does_not_allow_are_replaced_one_by_one) {
  Results grid = gated_results();
  grid.cases.front().definition.id = "a\xEF\xBF\xBE\xEF\xBF\xBF\x7Fz";  // U+FFFE, U+FFFF, DEL
  BOOST_TEST(junit_report(grid).find("\"a\?\?\?z\"") != std::string::npos, junit_report(grid));
}

BOOST_AUTO_TEST_CASE(each_cell_is_a_test_case_with_its_outcome_and_time) {
  const std::string text = junit_report(gated_results());
  BOOST_TEST(count(text, "<testcase name=\"(good|wild) dt=1/[12]0\" classname=\"family/case\" time=\"0.250000\"") == 4);
  BOOST_TEST(count(text, "<failure ") == 1 + 1);  // blown up; the gate that met no cell
  BOOST_TEST(count(text, "<error ") == 1);        // crashed
  BOOST_TEST(count(text, "<skipped message=\"known deviation: ") == 2);
  // The counts of the suite and of the whole.
  BOOST_TEST(count(text, "tests=\"5\" failures=\"2\" errors=\"1\" skipped=\"2\"") == 2);
}

BOOST_AUTO_TEST_CASE(a_failure_says_what_the_gate_says) {
  const std::string text = junit_report(gated_results());
  BOOST_TEST(text.find("type=\"position_error\"") != std::string::npos);
  BOOST_TEST(text.find("half a metre, ? &amp; no more") != std::string::npos);
  BOOST_TEST(text.find("st|one &quot;1&quot;, &lt;i&gt;") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_cell_that_fails_twice_says_both_and_what_is_known_beside_it_hides_nothing) {
  Results grid = gated_results();
  for (GateResult& answer : grid.cases.front().gates) answer.answer = GateAnswer::failed;
  BOOST_TEST(count(junit_report(grid), ">[^<\n]*&#10;bound: energy_drift[^<\n]*&#10;</failure>") == 2);  // of "good"
  for (GateResult& answer : grid.cases.front().gates) {
    if (answer.gate == 1) answer.answer = GateAnswer::known_deviation;
  }
  const std::string text = junit_report(grid);
  BOOST_TEST(count(text, "<skipped ") == 0, text);
  BOOST_TEST(count(text, "<failure ") == 2 + 1 + 1, text);  // "good", what blew up, the gate that met no cell
}

// Counted by hand: of the first case two failures, of the second (the same) as many again.
BOOST_AUTO_TEST_CASE(the_whole_counts_what_all_suites_have) {
  Results grid = gated_results();
  grid.cases.push_back(grid.cases.front());
  grid.cases.back().definition.id = "family/other";
  grid.cases.back().gates.clear();  // nothing failed there but the cell that crashed
  const std::string text = junit_report(grid);
  BOOST_TEST(count(text, "<testsuites name=\"rigor\" tests=\"9\" failures=\"2\" errors=\"2\" skipped=\"2\"") == 1,
             text);
  BOOST_TEST(count(text, "<testsuite name=\"family/case\" tests=\"5\" failures=\"2\"") == 1);
  BOOST_TEST(count(text, "<testsuite name=\"family/other\" tests=\"4\" failures=\"0\"") == 1);
}

BOOST_AUTO_TEST_CASE(an_unexpected_pass_is_a_failure_as_the_exit_code_says) {
  Results grid = gated_results();
  for (GateResult& answer : grid.cases.front().gates) {
    if (answer.gate == 1) answer.answer = GateAnswer::unexpected_pass;
  }
  BOOST_TEST(count(junit_report(grid), "tests=\"5\" failures=\"4\" errors=\"1\" skipped=\"0\"") == 2);
}

BOOST_AUTO_TEST_CASE(a_bound_and_a_regression_are_told_apart) {
  Results grid = gated_results();
  BOOST_TEST(count(junit_report(grid), "message=\"bound: ") > 0);
  test::limit_as<RegressionLimit>(grid.cases.front().definition.gates[0]).factor = 1.25;
  BOOST_TEST(count(junit_report(grid), "message=\"regression: position_error of wild") == 1);
}

BOOST_AUTO_TEST_CASE(a_test_that_passed_at_a_lower_order_says_so) {
  Results grid = gated_results();
  check_gates(grid.cases.front(), grid);
  const std::string before = junit_report(grid);
  BOOST_TEST(before.find("system-out") == std::string::npos);
  grid.cases.front().cells[0].reduced_order = ReducedOrder{0.25, "by <short> steps"};
  check_gates(grid.cases.front(), grid);
  const std::string text = junit_report(grid);
  BOOST_TEST(count(text, "<system-out>warning: from 0.25 s on stepped by &lt;short&gt; steps") == 1, text);
  BOOST_TEST(text.find(", but at dt = 1/10 from 0.25 s on") != std::string::npos, text);
  BOOST_TEST(count(text, "<failure ") == count(before, "<failure "));
  const Folder folder;
  const std::string file = folder.write("junit.xml", text);
  const std::string command =
      "xmllint --noout --schema " RIGOR_SOURCE_DIR "/tests/cases/report/junit/junit.xsd " + file + " 2>&1";
  BOOST_TEST(std::system(command.c_str()) == 0, text);
}

BOOST_AUTO_TEST_SUITE_END()
