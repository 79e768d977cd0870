#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <sstream>

#include "cases/report/json/leave_out_details.h"
#include "cases/report/reports.h"
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
