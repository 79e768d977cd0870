// The cells of a sweep, and the inputs of its results.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boost/test/unit_test.hpp>
#include <set>

#include "cases/analysis/sweep/sweep.h"
#include "cases/case/suite.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_sweep_grid)

namespace {

SweepInput input_of(const std::vector<std::string>& axes, std::size_t samples = 0, unsigned long seed = 0) {
  SweepInput input;
  input.cases = select_cases({"springs/fixed-spring"}, default_suite_dir(), test::words());
  input.runs = {parse_run_name("ode:quickstep", test::words().engines)};
  for (const std::string& axis : axes) input.axes.push_back(parse_axis(axis, samples > 0));
  input.samples = samples, input.seed = seed;
  return input;
}

const std::vector<std::string> kTwoByTwo = {"scene.spring[0].stiffness=100,200", "duration=1,2", "dt=1/30,1/60",
                                            "erp=0.1,0.2"};

}  // namespace

// The keys have equally many values, so keys that moved together would miss half of the grid.
BOOST_AUTO_TEST_CASE(every_combination_is_there_once) {
  const Sweep sweep(input_of(kTwoByTwo), test::words());
  BOOST_TEST(sweep.cells() == 16u);
  std::set<std::vector<std::string>> points;
  std::size_t rows = 0;
  for (std::size_t job = 0; job < sweep.jobs(); ++job) {
    const Case definition = sweep.definition_of(job);
    BOOST_TEST(sweep.first_row_of(job) == rows);
    for (const SweepRow& row : sweep.rows_of(job)) {
      ++rows, points.insert(row.values);
      BOOST_TEST(fmt::format("{:g}", definition.scene.springs[0].stiffness) == row.values[0]);
      BOOST_TEST(fmt::format("{:g}", definition.duration) == row.values[1]);
      BOOST_TEST(row.dt.text == row.values[2]);
      BOOST_TEST(sweep.run_of(row).settings.options.at("erp") == row.values[3]);
    }
  }
  BOOST_TEST(rows == 16u);
  BOOST_TEST(points.size() == 16u);
}

// A journal and the parts of a sweep belong to one plan: what changes results changes it.
BOOST_AUTO_TEST_CASE(a_plan_holds_all_that_its_results_depend_on) {
  const auto plan_of = [](SweepInput input) { return Sweep(std::move(input), test::words()).plan(); };
  const std::vector<std::string> range = {"scene.spring[0].stiffness=100..200"};
  const std::string plan = plan_of(input_of(range, 8, 1));
  BOOST_TEST(plan == plan_of(input_of(range, 8, 1)));
  std::set<std::string> plans = {plan, plan_of(input_of(range, 8, 2)), plan_of(input_of(range, 9, 1)),
                                 plan_of(input_of({"scene.spring[0].stiffness=100..201"}, 8, 1)),
                                 plan_of(input_of({"scene.spring[0].stiffness=100..200:log:3"}, 8, 1))};
  SweepInput other = input_of(range, 8, 1);
  other.runs = {parse_run_name("ode", test::words().engines)};
  plans.insert(plan_of(other));
  other = input_of(range, 8, 1);
  other.metrics = {"position_error"};
  plans.insert(plan_of(other));
  other = input_of(range, 8, 1);
  other.cases[0].duration /= 2;
  plans.insert(plan_of(other));
  other = input_of(range, 8, 1);
  other.cases[0].dt.pop_back();
  plans.insert(plan_of(other));
  BOOST_TEST(plans.size() == 9u);
}

BOOST_AUTO_TEST_SUITE_END()
