// The engine that comes nearest to a recording: engines are ranked, the core stands apart, and a mean without its hard
// trials is not compared.
#include "cases/report/wording/findings/recorded_finding.h"

#include <boost/test/unit_test.hpp>

#include "cases/report/wording/recommendation.h"
#include "cases/results/trial_results.h"
#include "cases/runner/grid.h"
#include "tests/cases/recorded_case.h"
#include "tests/cases/report/wording/claim_oracle.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_recorded_finding)

namespace {

// A planned grid over three trials, with these errors [%] in the cells of each run.
struct RunErrors {
  const char* run;
  std::vector<double> of_trials;  // those that have one
};

Results grid_with(const std::vector<RunErrors>& all, const Folder& folder) {
  folder.write("slide.csv", test::sliding_recording(0.3, 3, 1));
  const Case definition =
      read_case(folder.write("slide.toml", test::recorded_case(0.3, "slide.csv")), "slide", test::words());
  std::vector<RunName> runs;
  for (const RunErrors& one : all) runs.push_back(parse_run_name(one.run, test::words().engines));
  Results grid = plan_grid({definition}, runs, engines(), {.stable_steps = false});
  for (Cell& cell : grid.cases[0].cells) {
    const std::vector<double>& errors = all[cell.run].of_trials;
    std::vector<TrialResult> trials;
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      trials.push_back({fmt::format("t{}", k), Status::pass, "", {}});
      if (k < errors.size()) trials.back().metrics["mean_position_error"] = errors[k], sum += errors[k];
    }
    keep_trials(cell, trials);
    cell.metrics["mean_position_error"].value = sum / static_cast<double>(errors.size());
    cell.status = Status::pass;
  }
  return grid;
}

}  // namespace

BOOST_AUTO_TEST_CASE(engines_are_ranked_and_the_core_stands_apart) {
  const Folder folder;
  const Results grid = grid_with(
      {{"core:velocity-verlet", {1, 2, 2}}, {"ode", {7, 9, 8}}, {"bullet@stock", {6, 6, 6}}, {"bullet", {4, 5, 6}}},
      folder);
  const auto found = recommendation(grid);
  BOOST_TEST_REQUIRE(found.has_value());
  BOOST_TEST(found->topic == "recorded");
  BOOST_TEST(found->text == "Nearest to the recording: bullet at 0.005 s (5 %), the mean over 3 trials.");
  // The differences are 3, 4 and 2, and -3, -3 and -4; Student's t for three is 4.303.
  BOOST_TEST(
      found->more ==
      "Then: ode at 0.005 s (8 %; 0.52 to 5.5 more). Rigor's core stands apart: core:velocity-verlet at 0.005 s "
      "(1.67 %; 1.9 to 4.8 less). Differences from the nearest engine are paired by trial, with intervals of 95 %.");
  for (const std::string& error : test::errors_of(grid, *found)) BOOST_ERROR(error);
}

BOOST_AUTO_TEST_CASE(a_difference_that_may_be_chance_is_not_told_as_one) {
  const Folder folder;
  const Results grid = grid_with({{"ode", {5, 4, 7}}, {"bullet", {4, 5, 6}}}, folder);
  const auto found = recorded_finding(grid);
  BOOST_TEST_REQUIRE(found.has_value());
  BOOST_TEST(found->more.starts_with("Then: ode at 0.005 s (5.33 %; no certain difference: -2.5 to 3.2)."));
  for (const std::string& error : test::errors_of(grid, *found)) BOOST_ERROR(error);
}

BOOST_AUTO_TEST_CASE(a_mean_without_its_hard_trials_is_not_compared) {
  const Folder folder;
  const auto found = recorded_finding(grid_with({{"bullet", {4, 5, 60}}, {"ode", {4, 5}}}, folder));
  BOOST_TEST_REQUIRE(found.has_value());
  BOOST_TEST(found->text == "Nearest to the recording: bullet at 0.005 s (23 %), the mean over 3 trials.");
  BOOST_TEST(found->more == "Not compared, because trials have no error: ode at 0.005 s (2 of 3 have one).");
  const auto none = recorded_finding(grid_with({{"ode", {4, 5}}}, folder));
  BOOST_TEST_REQUIRE(none.has_value());
  BOOST_TEST(none->text == "Not compared, because trials have no error: ode at 0.005 s (2 of 3 have one).");
}

BOOST_AUTO_TEST_CASE(without_a_recording_nothing_is_said) { BOOST_TEST(!recorded_finding(Results{}).has_value()); }

BOOST_AUTO_TEST_SUITE_END()
