#include <boost/test/unit_test.hpp>

#include "cases/report/wording/explained_error.h"
#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_explained_error)

BOOST_AUTO_TEST_CASE(a_row_reads_total_by_the_scheme_and_unexplained) {
  const Results results = sample_results();
  const CaseResult& result = results.cases[0];
  const auto rows = explained_rows(results, result, result.definition.dt[0]);
  BOOST_REQUIRE(!rows.empty());
  BOOST_TEST(rows[0].engine == "good");
  BOOST_TEST(rows[0].total == "0.25");
  BOOST_TEST(rows[0].by_scheme == "0.24");
  BOOST_TEST(rows[0].unexplained == "0.01");
  BOOST_TEST(rows[0].rotation == "-");  // nothing turns
}

BOOST_AUTO_TEST_CASE(without_a_twin_there_is_no_table) {
  Results results = sample_results();
  for (Cell& cell : results.cases[0].cells) cell.scheme = {};
  BOOST_TEST(explained_rows(results, results.cases[0], results.cases[0].definition.dt[0]).empty());
}

BOOST_AUTO_TEST_SUITE_END()
