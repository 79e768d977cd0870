// The table of errors over a recording: a mean says over how many trials it is taken.
#include "cases/report/wording/recorded_error.h"

#include <boost/test/unit_test.hpp>

#include "cases/results/trial_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_recorded_error)

namespace {

// One run of three trials, of which the last ones have no value.
std::string mean_with(std::size_t lost) {
  Results results;
  results.runs.resize(1);
  CaseResult& result = results.cases.emplace_back();
  result.definition.truth = "recording";
  Cell& cell = result.cells.emplace_back();
  std::vector<TrialResult> trials;
  for (std::size_t k = 0; k < 3; ++k) {
    trials.push_back({std::to_string(k), Status::pass, "", {}});
    if (k + lost < 3) trials.back().metrics["mean_position_error"] = 4;
  }
  keep_trials(cell, trials);
  cell.metrics["mean_position_error"].value = 4;
  return recorded_errors(results, result).rows.at(1).at(2);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_mean_over_some_of_the_trials_says_so) {
  BOOST_TEST(mean_with(0) == "4 ± 0");
  BOOST_TEST(mean_with(1) == "4 ± 0, 2 of 3 trials");
}

BOOST_AUTO_TEST_SUITE_END()
