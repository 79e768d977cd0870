// Gates over several cells of a run, or over two runs: the order of its error, and which of two errs less.
#include <boost/test/unit_test.hpp>

#include "tests/cases/gates/gated_grid.h"
#include "tests/cases/limit_as.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_gates_orders_and_rankings)

BOOST_AUTO_TEST_CASE(each_run_answers_for_its_own_order) {
  GatedGrid run(2);
  for (Cell& cell : run.result().cells) {
    if (cell.run == 1) cell.metrics["position_error"].value = cell.dt.seconds;
  }
  Gate least = gate("position_error");
  test::limit_as<OrderLimit>(least).at_least = 1.9;
  const auto answers = run.check(least);
  BOOST_TEST_REQUIRE(answers.size() == 2u);
  for (const GateResult& answer : answers)
    BOOST_TEST((answer.answer == (answer.engine == "a" ? GateAnswer::held : GateAnswer::failed)), answer.text);
  // A cell that the metric says nothing of is none to fit.
  run.result().gates.clear();
  run.cell(0).metrics["position_error"].not_applicable = "says nothing";
  BOOST_TEST_REQUIRE(run.check(least).size() == 1u);
  BOOST_TEST(run.result().gates.front().engine == "b");
}

BOOST_AUTO_TEST_CASE(the_order_is_fitted_over_the_steps) {
  for (const double order : {1.0, 2.0, 4.0}) {
    GatedGrid run(order);
    Gate least = gate("position_error");
    test::limit_as<OrderLimit>(least).at_least = order - 0.01;
    BOOST_TEST(count(run.check(least), GateAnswer::held) == 2);
    test::limit_as<OrderLimit>(least).at_least = order + 0.01;
    BOOST_TEST(count(run.check(least), GateAnswer::failed) == 2);
  }
}

BOOST_AUTO_TEST_CASE(an_order_of_one_step_cannot_be_checked) {
  GatedGrid run;
  Gate least = gate("position_error");
  test::limit_as<OrderLimit>(least).at_least = 1, least.dt = {{0.1, "1/10"}};
  const auto answers = run.check(least);
  BOOST_TEST_REQUIRE(answers.size() == 1u);
  BOOST_TEST((answers.front().answer == GateAnswer::not_checked));
}

BOOST_AUTO_TEST_CASE(an_observed_order_is_held_against_its_bounds) {
  struct Row {
    std::optional<double> min, max;
    GateAnswer answer;
  };
  for (const Row& row :
       {Row{1.99, 2.01, GateAnswer::held}, Row{2.01, {}, GateAnswer::failed}, Row{{}, 1.99, GateAnswer::failed}}) {
    GatedGrid run(2);
    Gate limit = gate("observed_order");
    test::limit_as<BoundLimit>(limit).min = row.min, test::limit_as<BoundLimit>(limit).max = row.max;
    const auto answers = run.check(limit);
    BOOST_TEST_REQUIRE(answers.size() == 2u);
    for (const GateResult& answer : answers) BOOST_TEST((answer.answer == row.answer), answer.text);
    run.cell(3).status = Status::crashed;
    BOOST_TEST(run.check(limit).size() == 2u);  // a's order, and b's cell
    BOOST_TEST(count(run.check(limit), GateAnswer::failed) >= 1);
  }
}

BOOST_AUTO_TEST_CASE(an_order_is_fitted_over_all_of_the_steps) {
  GatedGrid run(2);
  CaseResult& result = run.result();
  for (const std::size_t of : {0u, 1u}) {
    Cell third = result.cells[of == 0 ? 1 : 3];
    third.dt = {0.025, "1/40"};  // the error falls no more: over the first two steps alone the order is 2
    result.cells.push_back(third);
  }
  Gate least = gate("position_error");
  test::limit_as<OrderLimit>(least).at_least = 1.5;
  BOOST_TEST(count(run.check(least), GateAnswer::failed) == 2);
  test::limit_as<OrderLimit>(least).at_least = 0.99;  // by least squares over dt, dt/2, dt/4: (2 + 0)/2
  BOOST_TEST(count(run.check(least), GateAnswer::held) == 2);
}

BOOST_AUTO_TEST_CASE(a_method_is_held_to_the_order_that_it_declares_where_its_errors_show_one) {
  const auto answers_of = [](double order, int declared, double scale, bool adaptive) {
    GatedGrid run(order);
    for (EngineInfo& engine : run.grid.engines)
      engine.methods.front().order = declared, engine.methods.front().adaptive = adaptive;
    for (Cell& cell : run.result().cells) cell.metrics["position_error"].value *= scale;
    Gate declares = gate("position_error");
    test::limit_as<OrderLimit>(declares).at_least = 0.1, test::limit_as<OrderLimit>(declares).is_declared = true,
    declares.is_of_family = true;
    declares.engines = {"a"};
    return run.check(declares);
  };
  BOOST_TEST(count(answers_of(2, 2, 1, false), GateAnswer::held) == 1);
  BOOST_TEST(count(answers_of(1.91, 2, 1, false), GateAnswer::held) == 1);
  BOOST_TEST(count(answers_of(1.89, 2, 1, false), GateAnswer::failed) == 1);
  BOOST_TEST(count(answers_of(2, 3, 1, false), GateAnswer::failed) == 1);
  BOOST_TEST(answers_of(1, 2, 100, false).empty());    // 10 and 5 m: not yet near the limit
  BOOST_TEST(answers_of(1, 2, 1e-10, false).empty());  // roundings
  BOOST_TEST(answers_of(1, 8, 0.1, true).empty());     // an adaptive method's errors do not follow from dt
}

// A step that is too long for a method, and what is within its roundings, say nothing of the order that it declares.
BOOST_AUTO_TEST_CASE(a_declared_order_is_judged_where_the_run_is_near_its_limit) {
  const auto answers_of = [](auto change) {
    GatedGrid run(2);
    run.grid.engines[0].methods.front().order = 2;
    CaseResult& result = run.result();
    Cell third = result.cells[1];
    third.dt = {0.025, "1/40"}, third.metrics["position_error"].value = 0.025 * 0.025;
    result.cells.push_back(third);
    change(result.cells[0], result);
    Gate declares = gate("position_error");
    test::limit_as<OrderLimit>(declares).at_least = 0.1, test::limit_as<OrderLimit>(declares).is_declared = true,
    declares.is_of_family = true;
    declares.engines = {"a"};
    return run.check(declares);
  };
  const auto all_held = [&](auto change) {
    const auto answers = answers_of(change);
    return answers.size() == 1 && answers.front().answer == GateAnswer::held;
  };
  BOOST_TEST(all_held([](Cell&, CaseResult&) {}));
  BOOST_TEST(all_held([](Cell& longest, CaseResult&) { longest.status = Status::diverged; }));
  const auto crashed = answers_of([](Cell& longest, CaseResult&) { longest.status = Status::crashed; });
  BOOST_TEST(count(crashed, GateAnswer::failed) == 1);
  // The finest step's would spoil the fit if it were large, the longest's if it were small.
  BOOST_TEST(all_held([](Cell&, CaseResult& result) { result.cells.back().metrics["position_error"].value = 0.03; }));
  const auto longest_is = [](double error) {
    return [error](Cell& longest, CaseResult&) { longest.metrics["position_error"].value = error; };
  };
  BOOST_TEST(all_held(longest_is(1e-10)));
  BOOST_TEST(!all_held(longest_is(2e-10)));
  // A truth sure of 1e-7 m shows nothing of errors up to a hundred times that.
  BOOST_TEST(all_held([](Cell& longest, CaseResult& result) {
    result.truth.emplace();
    result.truth->error_at_end = 0x1p-23, longest.metrics["position_error"].value = 100 * 0x1p-23;
  }));
}

BOOST_AUTO_TEST_CASE(a_ranking_holds_each_run_against_another_at_the_same_step) {
  GatedGrid run;  // a: .01 .0025; b: .1 .025
  Gate ranking = gate("position_error");
  ranking.engines = {"a"}, test::limit_as<RankingLimit>(ranking).better_than = "b";
  BOOST_TEST(count(run.check(ranking), GateAnswer::held) == 2);
  ranking.engines = {"b"}, test::limit_as<RankingLimit>(ranking).better_than = "a";
  const auto answers = run.check(ranking);
  BOOST_TEST(count(answers, GateAnswer::failed) == 2);
  BOOST_TEST(answers.front().text.find("0.1 m, not better than the 0.01 m of a") != std::string::npos,
             answers.front().text);
  BOOST_TEST((run.cell(2).status == Status::fail));
}

BOOST_AUTO_TEST_CASE(who_blew_up_is_better_than_nobody) {
  GatedGrid run;
  Gate ranking = gate("position_error");
  ranking.engines = {"b"}, test::limit_as<RankingLimit>(ranking).better_than = "a";
  run.cell(0).status = Status::diverged;  // a at the first step: its small error means nothing
  BOOST_TEST(count(run.check(ranking), GateAnswer::held) == 1);
  run.cell(2).status = Status::diverged;  // and so does b
  BOOST_TEST(count(run.check(ranking), GateAnswer::held) == 0);
  run.cell(0).status = Status::pass;
  BOOST_TEST(count(run.check(ranking), GateAnswer::held) == 0);
}

BOOST_AUTO_TEST_CASE(a_ranking_against_a_run_that_came_to_nothing_fails) {
  GatedGrid run;
  Gate ranking = gate("position_error");
  ranking.engines = {"a"}, test::limit_as<RankingLimit>(ranking).better_than = "b";
  run.cell(2).status = Status::crashed;
  BOOST_TEST(count(run.check(ranking), GateAnswer::failed) == 1);
  run.cell(2).status = Status::unsupported;  // that is nobody's fault
  BOOST_TEST(count(run.check(ranking), GateAnswer::failed) == 0);
}

BOOST_AUTO_TEST_CASE(a_ranking_does_not_hold_where_both_are_the_same) {
  GatedGrid run;
  for (Cell& cell : run.result().cells) cell.metrics["position_error"].value = 0.01;
  Gate ranking = gate("position_error");
  ranking.engines = {"a"}, test::limit_as<RankingLimit>(ranking).better_than = "b";
  BOOST_TEST(count(run.check(ranking), GateAnswer::failed) == 2);
}

// Of a metric of which more is better, the larger value is ahead.
BOOST_AUTO_TEST_CASE(a_ranking_knows_of_which_metrics_more_is_better) {
  GatedGrid run;
  for (std::size_t n = 0; n < 4; ++n) {
    run.cell(n).metrics["survival"] = run.cell(n).metrics["position_error"];
    run.cell(n).metrics["survival"].value = n < 2 ? 0.5 : 0.25;  // a, b
  }
  Gate ranking = gate("survival");
  ranking.engines = {"a"}, test::limit_as<RankingLimit>(ranking).better_than = "b";
  BOOST_TEST(count(run.check(ranking), GateAnswer::held) == 2);
  ranking.engines = {"b"}, test::limit_as<RankingLimit>(ranking).better_than = "a";
  BOOST_TEST(count(run.check(ranking), GateAnswer::failed) == 2);
}

BOOST_AUTO_TEST_SUITE_END()
