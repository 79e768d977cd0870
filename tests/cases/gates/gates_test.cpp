#include "cases/gates/gates.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "tests/cases/runner/faulty_engine.h"

using namespace rigor;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Two engines at two steps; position_error is c dt^order with c = 1 for "a", 10 for "b".
struct Fixture {
  Results grid;

  explicit Fixture(double order = 2) {
    EngineTable table;
    for (const char* name : {"a", "b"}) table.add(std::make_unique<FaultyEngine>(name, [](double&) {}));
    grid.engines = infos_of(table);
    for (const char* name : {"a", "b"}) grid.runs.push_back(parse_run_name(name, grid.engines));
    CaseResult result;
    result.definition = drifting_body("case");
    for (std::size_t run = 0; run < 2; ++run) {
      for (const StepSize& dt : result.definition.dt) {
        Cell cell;
        cell.run = run, cell.dt = dt, cell.status = Status::pass, cell.reason = "";
        MetricValue value;
        value.value = (run == 0 ? 1 : 10) * std::pow(dt.seconds, order);
        value.worst = {0.25, 0, "position.x", 1.5, 1.25};
        cell.metrics["position_error"] = value;
        result.cells.push_back(cell);
      }
    }
    grid.cases.push_back(result);
  }

  CaseResult& result() { return grid.cases.front(); }
  Cell& cell(std::size_t index) { return result().cells[index]; }
  const std::vector<GateResult>& check(const Gate& gate) {
    result().definition.gates = {gate};
    check_gates(result(), grid);
    return result().gates;
  }
};

Gate gate(const std::string& metric) {
  Gate out;
  out.metric = metric, out.because = "a reason", out.where = "case.toml:7:1";
  return out;
}

int count(const std::vector<GateResult>& results, GateAnswer answer) {
  return static_cast<int>(
      std::count_if(results.begin(), results.end(), [&](const auto& r) { return r.answer == answer; }));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cases_gates_gates)

BOOST_AUTO_TEST_CASE(a_limit_is_held_against_every_cell_it_selects) {
  Fixture run;  // a: .01 .0025; b: .1 .025
  Gate limit = gate("position_error");
  limit.max = 0.05;
  const auto answers = run.check(limit);
  BOOST_TEST(answers.size() == 4u);
  BOOST_TEST(count(answers, GateAnswer::failed) == 1);
  BOOST_TEST((run.cell(2).status == Status::fail));
  BOOST_TEST((run.cell(0).status == Status::pass));
  BOOST_TEST(!all_gates_hold(run.grid));
  for (const std::string part : {"0.1 m", "0.05 m", "0.25 s", "stone", "position.x", "1.5", "1.25", "a reason"}) {
    BOOST_TEST(run.cell(2).reason.find(part) != std::string::npos, part << " in " << run.cell(2).reason);
  }
}

BOOST_AUTO_TEST_CASE(a_gate_passes_over_the_runs_that_the_truth_is_made_like) {
  Fixture run;
  run.grid.runs[1].engine = "core", run.grid.runs[1].settings.options["contact"] = "event";
  run.result().definition.truth = "events";
  Gate limit = gate("position_error");
  limit.max = 0.001;  // none of them holds it
  BOOST_TEST(count(run.check(limit), GateAnswer::failed) == 2);
  for (const GateResult& answer : run.result().gates) BOOST_TEST(answer.engine == "a");
  run.result().definition.truth = "reference";
  run.result().gates.clear();
  BOOST_TEST(count(run.check(limit), GateAnswer::failed) == 4);
}

BOOST_AUTO_TEST_CASE(engines_and_steps_narrow_a_gate) {
  Fixture run;
  Gate limit = gate("position_error");
  limit.max = 0.05, limit.engines = {"b"}, limit.dt = {{0.05, "0.05"}};  // the cell's is written "1/20"
  const auto answers = run.check(limit);
  BOOST_TEST_REQUIRE(answers.size() == 1u);
  BOOST_TEST((answers.front().answer == GateAnswer::held));
  BOOST_TEST(answers.front().engine == "b");
  BOOST_TEST(all_gates_hold(run.grid));
}

BOOST_AUTO_TEST_CASE(min_and_equals_hold_on_their_side_only) {
  struct Row {
    std::optional<double> min, equals;
    bool holds;
  };
  // The value is .01; a rounding of 1e-12 is forgiven, an error of 1e-8 is not.
  for (const Row& row :
       {Row{0.009, {}, true}, Row{0.011, {}, false}, Row{{}, 0.01 + 1e-12, true}, Row{{}, 0.01 + 1e-8, false}}) {
    Fixture run;
    Gate limit = gate("position_error");
    limit.min = row.min, limit.equals = row.equals, limit.engines = {"a"}, limit.dt = {{0.1, "1/10"}};
    BOOST_TEST((run.check(limit).front().answer == GateAnswer::held) == row.holds);
  }
}

BOOST_AUTO_TEST_CASE(a_bound_that_is_met_exactly_holds) {
  const auto holds = [](double value, const auto& bound) {
    Fixture run;
    run.cell(0).metrics["position_error"].value = value;
    Gate limit = gate("position_error");
    limit.engines = {"a"}, limit.dt = {{0.1, "1/10"}};
    bound(limit);
    return run.check(limit).front().answer == GateAnswer::held;
  };
  BOOST_TEST(holds(0.3, [](Gate& gate) { gate.max = 0.3; }));
  BOOST_TEST(holds(0.3, [](Gate& gate) { gate.min = 0.3; }));
  // A rounding is one of what is asked for, and of 1 where that is less.
  BOOST_TEST(holds(0.1 + 0.9 * kRounding, [](Gate& gate) { gate.equals = 0.1; }));
  BOOST_TEST(!holds(0.1 + 1.2 * kRounding, [](Gate& gate) { gate.equals = 0.1; }));
  BOOST_TEST(holds(100 + 90 * kRounding, [](Gate& gate) { gate.equals = 100; }));
  BOOST_TEST(!holds(100 + 120 * kRounding, [](Gate& gate) { gate.equals = 100; }));
}

BOOST_AUTO_TEST_CASE(each_run_answers_for_its_own_order) {
  Fixture run(2);
  for (Cell& cell : run.result().cells) {
    if (cell.run == 1) cell.metrics["position_error"].value = cell.dt.seconds;
  }
  Gate least = gate("position_error");
  least.at_least_order = 1.9;
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

BOOST_AUTO_TEST_CASE(a_value_that_is_no_number_holds_nowhere) {
  for (const int bound : {0, 1, 2, 3}) {
    Fixture run;
    for (Cell& cell : run.result().cells) cell.metrics["position_error"].value = kNan;
    Gate limit = gate("position_error");
    (bound == 0 ? limit.max : bound == 1 ? limit.min : bound == 2 ? limit.equals : limit.at_least_order) = 0.01;
    for (const GateResult& answer : run.check(limit)) BOOST_TEST((answer.answer == GateAnswer::failed));
  }
}

BOOST_AUTO_TEST_CASE(the_order_is_fitted_over_the_steps) {
  for (const double order : {1.0, 2.0, 4.0}) {
    Fixture run(order);
    Gate least = gate("position_error");
    least.at_least_order = order - 0.01;
    BOOST_TEST(count(run.check(least), GateAnswer::held) == 2);
    least.at_least_order = order + 0.01;
    BOOST_TEST(count(run.check(least), GateAnswer::failed) == 2);
  }
}

BOOST_AUTO_TEST_CASE(an_order_of_one_step_cannot_be_checked) {
  Fixture run;
  Gate least = gate("position_error");
  least.at_least_order = 1, least.dt = {{0.1, "1/10"}};
  const auto answers = run.check(least);
  BOOST_TEST_REQUIRE(answers.size() == 1u);
  BOOST_TEST((answers.front().answer == GateAnswer::not_checked));
}

BOOST_AUTO_TEST_CASE(a_gate_that_meets_no_cell_is_not_checked_and_does_not_hold) {
  const auto check = [](Fixture& run, const Gate& limit) {
    const auto answers = run.check(limit);
    BOOST_TEST_REQUIRE(answers.size() == 1u);
    BOOST_TEST((answers.front().answer == GateAnswer::not_checked));
    BOOST_TEST(answers.front().text.find("case.toml:7:1") != std::string::npos);
    BOOST_TEST(!all_gates_hold(run.grid));
  };
  Fixture other_step, no_metric, unsupported;
  Gate limit = gate("position_error");
  limit.max = 1;
  for (Cell& cell : no_metric.result().cells) cell.metrics["position_error"].not_applicable = "there is no truth";
  check(no_metric, limit);
  for (Cell& cell : unsupported.result().cells) cell.status = Status::unsupported, cell.metrics.clear();
  check(unsupported, limit);
  limit.dt = {{1. / 30, "1/30"}};
  check(other_step, limit);
}

BOOST_AUTO_TEST_CASE(a_cell_without_a_result_fails_every_gate_that_selects_it) {
  for (const Status status : {Status::crashed, Status::timed_out, Status::invalid}) {
    Fixture run;
    run.cell(0).status = status, run.cell(0).reason = "it broke", run.cell(0).metrics.clear();
    for (const bool order : {false, true}) {
      Gate limit = gate("position_error");
      (order ? limit.at_least_order : limit.max) = 1;
      const auto answers = run.check(limit);
      BOOST_TEST(count(answers, GateAnswer::failed) == 1);
      BOOST_TEST((run.cell(0).status == status));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_blown_up_run_never_passes_a_limit_but_may_be_asked_for) {
  Fixture run;
  run.cell(0).status = Status::diverged, run.cell(0).reason = "blown up at 0.1 s: stone";
  Gate limit = gate("position_error");
  limit.engines = {"a"}, limit.dt = {{0.1, "1/10"}}, limit.max = 1e9;
  BOOST_TEST((run.check(limit).front().answer == GateAnswer::failed));
  BOOST_TEST((run.cell(0).status == Status::diverged));
  limit.max = {}, limit.min = 0.001;
  BOOST_TEST((run.check(limit).front().answer == GateAnswer::held));
}

BOOST_AUTO_TEST_CASE(a_blown_up_run_is_never_good_where_more_is_better) {
  Fixture run;
  run.cell(0).status = Status::diverged, run.cell(0).reason = "blown up at 0.1 s: stone";
  run.cell(0).metrics["tube"].value = 1;  // until it blew up
  Gate limit = gate("tube");
  limit.engines = {"a"}, limit.dt = {{0.1, "1/10"}}, limit.min = 0.5;
  BOOST_TEST((run.check(limit).front().answer == GateAnswer::failed));
}

BOOST_AUTO_TEST_CASE(an_observed_order_is_held_against_its_bounds) {
  struct Row {
    std::optional<double> min, max;
    GateAnswer answer;
  };
  for (const Row& row :
       {Row{1.99, 2.01, GateAnswer::held}, Row{2.01, {}, GateAnswer::failed}, Row{{}, 1.99, GateAnswer::failed}}) {
    Fixture run(2);
    for (Cell& cell : run.result().cells) cell.metrics["cost"].value = 1;
    Gate limit = gate("observed_order");
    limit.min = row.min, limit.max = row.max;
    const auto answers = run.check(limit);
    BOOST_TEST_REQUIRE(answers.size() == 2u);
    for (const GateResult& answer : answers) BOOST_TEST((answer.answer == row.answer), answer.text);
    run.cell(3).status = Status::crashed;
    BOOST_TEST(run.check(limit).size() == 2u);  // a's order, and b's cell
    BOOST_TEST(count(run.check(limit), GateAnswer::failed) >= 1);
  }
}

BOOST_AUTO_TEST_CASE(a_spread_is_held_against_every_pair_a_gate_selects) {
  Fixture run;
  run.result().spreads = {{0, 1, {0.1, "1/10"}, {0.5, 0.3, 0}, {0.01, 0.2, 0}, 0.1, 0.5},
                          {0, 1, {0.05, "1/20"}, {0.125, 0.3, 0}, {0.02, 0.2, 0}, 0.1, 0.5}};
  Gate limit = gate("spread");
  limit.max = 0.25;
  BOOST_TEST(count(run.check(limit), GateAnswer::held) == 1);
  BOOST_TEST(count(run.check(limit), GateAnswer::failed) == 1);
  const std::string text = run.check(limit).front().text;
  for (const std::string part : {"a and b", "0.5 m", "0.3 s", "stone"}) {
    BOOST_TEST(text.find(part) != std::string::npos, part << " in " << text);
  }
  Gate turn = gate("spread_orientation");
  turn.max = 0.015, turn.dt = {{0.1, "1/10"}};
  BOOST_TEST((run.check(turn).front().answer == GateAnswer::held));
  limit.engines = {"a"};  // no pair
  BOOST_TEST((run.check(limit).front().answer == GateAnswer::not_checked));
  limit.engines = {}, limit.max = 10;
  run.cell(2).status = Status::diverged;
  BOOST_TEST(count(run.check(limit), GateAnswer::failed) == 1);
  BOOST_TEST(count(run.check(limit), GateAnswer::held) == 1);
}

BOOST_AUTO_TEST_CASE(a_ranking_holds_each_run_against_another_at_the_same_step) {
  Fixture run;  // a: .01 .0025; b: .1 .025
  Gate ranking = gate("position_error");
  ranking.engines = {"a"}, ranking.better_than = "b";
  BOOST_TEST(count(run.check(ranking), GateAnswer::held) == 2);
  ranking.engines = {"b"}, ranking.better_than = "a";
  const auto answers = run.check(ranking);
  BOOST_TEST(count(answers, GateAnswer::failed) == 2);
  BOOST_TEST(answers.front().text.find("0.1 m, not better than the 0.01 m of a") != std::string::npos,
             answers.front().text);
  BOOST_TEST((run.cell(2).status == Status::fail));
}

BOOST_AUTO_TEST_CASE(who_blew_up_is_better_than_nobody) {
  Fixture run;
  Gate ranking = gate("position_error");
  ranking.engines = {"b"}, ranking.better_than = "a";
  run.cell(0).status = Status::diverged;  // a at the first step: its small error means nothing
  BOOST_TEST(count(run.check(ranking), GateAnswer::held) == 1);
  run.cell(2).status = Status::diverged;  // and so does b
  BOOST_TEST(count(run.check(ranking), GateAnswer::held) == 0);
  run.cell(0).status = Status::pass;
  BOOST_TEST(count(run.check(ranking), GateAnswer::held) == 0);
}

BOOST_AUTO_TEST_CASE(a_ranking_against_a_run_that_came_to_nothing_fails) {
  Fixture run;
  Gate ranking = gate("position_error");
  ranking.engines = {"a"}, ranking.better_than = "b";
  run.cell(2).status = Status::crashed;
  BOOST_TEST(count(run.check(ranking), GateAnswer::failed) == 1);
  run.cell(2).status = Status::unsupported;  // that is nobody's fault
  BOOST_TEST(count(run.check(ranking), GateAnswer::failed) == 0);
}

BOOST_AUTO_TEST_CASE(an_order_is_fitted_over_all_of_the_steps) {
  Fixture run(2);
  CaseResult& result = run.result();
  for (const std::size_t of : {0u, 1u}) {
    Cell third = result.cells[of == 0 ? 1 : 3];
    third.dt = {0.025, "1/40"};  // the error falls no more: over the first two steps alone the order is 2
    result.cells.push_back(third);
  }
  Gate least = gate("position_error");
  least.at_least_order = 1.5;
  BOOST_TEST(count(run.check(least), GateAnswer::failed) == 2);
  least.at_least_order = 0.99;  // by least squares over dt, dt/2, dt/4: (2 + 0)/2
  BOOST_TEST(count(run.check(least), GateAnswer::held) == 2);
}

BOOST_AUTO_TEST_CASE(a_ranking_does_not_hold_where_both_are_the_same) {
  Fixture run;
  for (Cell& cell : run.result().cells) cell.metrics["position_error"].value = 0.01;
  Gate ranking = gate("position_error");
  ranking.engines = {"a"}, ranking.better_than = "b";
  BOOST_TEST(count(run.check(ranking), GateAnswer::failed) == 2);
}

BOOST_AUTO_TEST_CASE(a_method_is_held_to_the_order_that_it_declares_where_its_errors_show_one) {
  const auto answers_of = [](double order, int declared, double scale, bool adaptive) {
    Fixture run(order);
    for (EngineInfo& engine : run.grid.engines)
      engine.methods.front().order = declared, engine.methods.front().adaptive = adaptive;
    for (Cell& cell : run.result().cells) cell.metrics["position_error"].value *= scale;
    Gate declares = gate("position_error");
    declares.at_least_order = 0.1, declares.declares_order = true, declares.is_of_family = true;
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

BOOST_AUTO_TEST_CASE(a_familys_gate_says_nothing_of_a_case_that_it_does_not_meet_but_of_a_whole_suite) {
  Fixture run;
  Gate limit = gate("creep");  // which no cell has
  limit.max = 1, limit.is_of_family = true;
  BOOST_TEST(run.check(limit).empty());
  BOOST_TEST(all_gates_hold(run.grid));
  const auto unmet = unmet_family_gates(run.grid);
  BOOST_TEST_REQUIRE(unmet.size() == 1u);
  BOOST_TEST(unmet.front().where == "case.toml:7:1");
  limit.metric = "position_error", limit.max = 100;
  run.check(limit);
  BOOST_TEST(unmet_family_gates(run.grid).empty());
}

// The stone comes 0.5 m far at 1 m/s in 5 or 10 steps: 8 roundings of 2^-24 of 1 m a step make 1.1e-6 m.
BOOST_AUTO_TEST_CASE(limits_are_wider_for_single_precision_by_its_roundings_and_no_more) {
  Gate limit = gate("position_error");
  limit.max = 1e-9;
  const auto answers_of = [&](double error) {
    Fixture run;
    run.grid.engines[1].precision = "single";
    for (std::size_t n = 0; n < 4; ++n) run.cell(n).metrics["position_error"].value = error;
    return run.check(limit);
  };
  const auto answers = answers_of(0.9e-6);
  BOOST_TEST(count(answers, GateAnswer::held) == 2);
  for (const GateResult& answer : answers) {
    BOOST_TEST((answer.answer == (answer.engine == "b" ? GateAnswer::held : GateAnswer::failed)), answer.text);
    const bool says_so = answer.text.find("for single precision") != std::string::npos;
    BOOST_TEST(says_so == (answer.engine == "b"), answer.text);
  }
  BOOST_TEST(count(answers_of(3e-6), GateAnswer::held) == 0);
}

// A run may go on by steps of less than its method's order: what it was held to then says nothing of the method.
BOOST_AUTO_TEST_CASE(a_gate_that_held_over_a_time_of_reduced_order_says_so) {
  Fixture fixture;
  Gate limit = gate("position_error"), order = gate("position_error");
  limit.max = 1, order.at_least_order = 1.9;
  for (std::size_t i = 0; i < 4; ++i) fixture.cell(i).metrics["position_error"].compared_until = 0.5;
  fixture.cell(0).reduced_order = ReducedOrder{0.2, "by short steps"};
  fixture.cell(2).reduced_order = ReducedOrder{0.5, "by short steps"};  // what was compared ends there
  const auto caveats = [&](const Gate& of) {
    std::vector<std::string> found;
    for (const GateResult& answer : fixture.check(of)) {
      BOOST_TEST((answer.answer == GateAnswer::held), answer.text);
      if (!answer.caveat.empty()) found.push_back(answer.engine + ": " + answer.caveat);
    }
    return found;
  };
  const std::vector<std::string> one = {"a: at dt = 1/10 from 0.2 s on stepped by short steps"};
  BOOST_TEST(caveats(limit) == one, boost::test_tools::per_element());
  BOOST_TEST(caveats(order) == one, boost::test_tools::per_element());
  fixture.cell(0).metrics["cost"] = fixture.cell(0).metrics["position_error"];
  Gate cost = gate("cost");
  cost.max = 1, cost.engines = {"a"}, cost.dt = {{0.1, "1/10"}};
  BOOST_TEST(caveats(cost).empty());
  BOOST_TEST(all_gates_hold(fixture.grid));
}

BOOST_AUTO_TEST_SUITE_END()
