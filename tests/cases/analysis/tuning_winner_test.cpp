// Which of several settings wins a tuning.
#include <boost/test/unit_test.hpp>

#include "cases/analysis/tuning/tuning.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_tuning_winner)

namespace {

TunedPoint point(const std::string& run, const StepSize& dt, double least, double cost, double most) {
  return {RunName{"ode", {}, run}, dt, 0.5, cost, least, most, ""};
}

const StepSize kLong{0.1, "1/10"}, kShort{0.01, "1/100"};

std::vector<std::string> runs_of(const std::vector<TunedPoint>& points) {
  std::vector<std::string> runs;
  for (const TunedPoint& one : points) runs.push_back(one.run.text + " " + one.dt.text);
  return runs;
}

}  // namespace

// The median of "b" is larger than all costs of "a", and its least cost is not: repeats cannot tell them apart.
BOOST_AUTO_TEST_CASE(repeats_that_overlap_are_a_tie_and_others_are_none) {
  const auto tied = equally_cheap({point("a,x=1", kLong, 1, 2, 3), point("b", kLong, 2.9, 4, 9),
                                   point("c", kLong, 3.1, 3.2, 3.3), point("d,x=1", kLong, 3, 5, 6)});
  const std::vector<std::string> expected = {"b 1/10", "a,x=1 1/10", "d,x=1 1/10"};
  BOOST_TEST(runs_of(tied) == expected, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(of_a_tie_the_fewest_options_win_then_the_longest_step_then_the_name) {
  const auto tied = equally_cheap({point("b", kShort, 1, 2, 3), point("a", kShort, 1, 2.1, 3),
                                   point("c", kLong, 1, 2.2, 3), point("a,x=1", kLong, 1, 1.9, 3)});
  const std::vector<std::string> expected = {"c 1/10", "a 1/100", "b 1/100", "a,x=1 1/10"};
  BOOST_TEST(runs_of(tied) == expected, boost::test_tools::per_element());
  BOOST_TEST(equally_cheap({}).empty());
}

BOOST_AUTO_TEST_SUITE_END()
