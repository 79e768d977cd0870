// Gates on the distance between runs.
#include <boost/test/unit_test.hpp>

#include "tests/cases/gates/gated_grid.h"
#include "tests/cases/limit_as.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_gates_spreads)

BOOST_AUTO_TEST_CASE(a_spread_is_held_against_every_pair_a_gate_selects) {
  GatedGrid run;
  run.result().spreads = {{0, 1, {0.1, "1/10"}, {0.5, 0.3, 0}, {0.01, 0.2, 0}, 0.1, 0.5},
                          {0, 1, {0.05, "1/20"}, {0.125, 0.3, 0}, {0.02, 0.2, 0}, 0.1, 0.5}};
  Gate limit = gate("spread");
  test::limit_as<BoundLimit>(limit).max = 0.25;
  BOOST_TEST(count(run.check(limit), GateAnswer::held) == 1);
  BOOST_TEST(count(run.check(limit), GateAnswer::failed) == 1);
  const std::string text = run.check(limit).front().text;
  for (const std::string part : {"a and b", "0.5 m", "0.3 s", "stone"}) {
    BOOST_TEST(text.find(part) != std::string::npos, part << " in " << text);
  }
  Gate turn = gate("spread_orientation");
  test::limit_as<BoundLimit>(turn).max = 0.015, turn.dt = {{0.1, "1/10"}};
  BOOST_TEST((run.check(turn).front().answer == GateAnswer::held));
  limit.engines = {"a"};  // no pair
  BOOST_TEST((run.check(limit).front().answer == GateAnswer::not_checked));
  limit.engines = {}, test::limit_as<BoundLimit>(limit).max = 10;
  run.cell(2).status = Status::diverged;
  BOOST_TEST(count(run.check(limit), GateAnswer::failed) == 1);
  BOOST_TEST(count(run.check(limit), GateAnswer::held) == 1);
}

BOOST_AUTO_TEST_CASE(a_spread_of_a_pair_or_a_step_that_is_not_selected_is_not_judged) {
  GatedGrid run;
  run.result().spreads = {{0, 1, {0.1, "1/10"}, {0.5, 0.3, 0}, {0.01, 0.2, 0}, 0.1, 0.5}};
  Gate limit = gate("spread");
  test::limit_as<BoundLimit>(limit).max = 1;
  for (const char* one : {"a", "b"}) {
    limit.engines = {one};
    BOOST_TEST((run.check(limit).front().answer == GateAnswer::not_checked), one);
  }
  limit.engines = {}, limit.dt = {{0.05, "1/20"}};
  BOOST_TEST((run.check(limit).front().answer == GateAnswer::not_checked));
  // Of a run with itself at its finest step it is another question.
  run.result().spreads[0].second = 0, limit.dt = {};
  BOOST_TEST((run.check(limit).front().answer == GateAnswer::not_checked));
}

BOOST_AUTO_TEST_SUITE_END()
