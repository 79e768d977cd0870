// What is found of contacts, as data; how it is said is tested beside the wording.
#include "cases/analysis/contact_diagnosis.h"

#include <boost/test/unit_test.hpp>

#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_contact_diagnosis)

BOOST_AUTO_TEST_CASE(a_diagnosis_says_of_what_run_and_case_how_much_and_why) {
  Results grid = sample_results();
  CaseResult& result = grid.cases.front();
  BOOST_TEST(contact_diagnoses(result).empty());
  const bool first_is_coarse = result.cells[0].dt.seconds > result.cells[1].dt.seconds;
  for (int i = 0; i < 2; ++i) {
    const double value = (i == 0) == first_is_coarse ? 0.05 : 0.5;
    result.cells[i].metrics["restitution_error"] = sample_metric(value, {0.5, 0, "restitution", 0.5, 1});
    result.cells[i].settings = {{"restitution", "across a gap"}};
  }
  const auto found = contact_diagnoses(result);
  BOOST_TEST_REQUIRE(found.size() == 1u);
  BOOST_TEST(found[0].topic == kUnconverged);
  BOOST_TEST((found[0].runs == std::vector<std::size_t>{0}));
  BOOST_TEST(found[0].of_case == "family/case");
  BOOST_TEST(found[0].value == 0.5);
  BOOST_TEST(found[0].cause == "Its setting \"restitution\": across a gap.");
  BOOST_TEST_REQUIRE(found[0].over.size() == 2u);
  BOOST_TEST(found[0].over[0].first.seconds > found[0].over[1].first.seconds);
  BOOST_TEST(found[0].over[0].second == 0.05);
}

BOOST_AUTO_TEST_SUITE_END()
