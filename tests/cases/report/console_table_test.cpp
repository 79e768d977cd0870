#include "cases/report/console_table.h"

#include <boost/test/unit_test.hpp>
#include <sstream>

#include "tests/cases/report/sample_results.h"

using namespace rigor;

namespace {

std::string line_with(const std::string& text, const std::string& start) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(start)) return line;
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cases_report_console_table)

BOOST_AUTO_TEST_CASE(a_row_shows_errors_signed_drift_and_the_largest_step) {
  const std::string line = line_with(console_table(sample_results()), "  good ");
  for (const char* part : {" 0.125 ", " 0.25 ", " -50 ", " 0.0678 ", " stable"}) {
    BOOST_TEST(line.find(part) != std::string::npos, part << " in " << line);
  }
}

BOOST_AUTO_TEST_CASE(a_run_that_blew_up_shows_when_and_what_and_no_errors) {
  const std::string line = line_with(console_table(sample_results()), "  wild ");
  BOOST_TEST(line.find("blown up at 0.40 s: st|one") != std::string::npos, line);
  BOOST_TEST(line.find("0.125") == std::string::npos, line);
  BOOST_TEST(line.find("timed-out") != std::string::npos, line);  // of its largest stable step
}

BOOST_AUTO_TEST_CASE(a_cell_without_numbers_says_why) {
  Results results = sample_results();
  results.cases.front().definition.dt = {{0.05, "1/20"}};  // where the second engine crashed
  const std::string line = line_with(console_table(results), "  wild ");
  BOOST_TEST(line.find("crashed: killed by SIGSEGV") != std::string::npos, line);
}

BOOST_AUTO_TEST_CASE(every_line_fits_a_hundred_columns) {
  Results results = sample_results();
  std::string reason = "crashed because";
  for (int i = 0; i < 60; ++i) reason += " of one thing after another";
  results.cases.front().cells[2].metrics.clear();
  results.cases.front().cells[2].reason = reason;
  results.cases.front().cells[0].stability = {Verdict::blown_up, 123.4, 0, ""};
  results.cases.front().definition.scene.bodies.front().name = "a body of a name that no table was made for";
  results.runs[0].text = "core:explicit-euler,orientation=matrix-rodrigues";
  results.cases.front().definition.title = reason;
  results.cases.front().gates.push_back({0, "good", "1/10", GateAnswer::failed, reason});
  std::istringstream lines(console_table(results));
  for (std::string line; std::getline(lines, line);) BOOST_TEST(line.size() <= 100u, line);
}

BOOST_AUTO_TEST_CASE(a_truth_says_how_far_it_can_be_trusted) {
  Results results = sample_results();
  CaseResult& result = results.cases.front();
  result.definition.truth = "reference", result.definition.duration = 30;
  result.truth->horizon = 17.81;
  BOOST_TEST(truth_sentence(result).find("until 17.8 s of the 30 s") != std::string::npos, truth_sentence(result));
  result.truth->horizon = 30;
  BOOST_TEST(truth_sentence(result).find("over the whole 30 s") != std::string::npos, truth_sentence(result));
  result.definition.truth = "none";
  BOOST_TEST(truth_sentence(result).find("none") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
