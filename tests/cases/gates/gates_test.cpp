#include "cases/gates/gates.h"

#include <boost/test/unit_test.hpp>
#include <limits>

#include "cases/gates/failures.h"
#include "tests/cases/gates/gated_grid.h"
#include "tests/cases/limit_as.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_gates_gates)

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

BOOST_AUTO_TEST_CASE(a_limit_is_held_against_every_cell_it_selects) {
  GatedGrid run;  // a: .01 .0025; b: .1 .025
  Gate limit = gate("position_error");
  test::limit_as<BoundLimit>(limit).max = 0.05;
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
  GatedGrid run;
  run.grid.runs[1].engine = "core", run.grid.runs[1].settings.options["contact"] = "event";
  run.result().definition.truth = "events";
  Gate limit = gate("position_error");
  test::limit_as<BoundLimit>(limit).max = 0.001;  // none of them holds it
  BOOST_TEST(count(run.check(limit), GateAnswer::failed) == 2);
  for (const GateResult& answer : run.result().gates) BOOST_TEST(answer.engine == "a");
  run.result().definition.truth = "reference";
  run.result().gates.clear();
  BOOST_TEST(count(run.check(limit), GateAnswer::failed) == 4);
}

BOOST_AUTO_TEST_CASE(engines_and_steps_narrow_a_gate) {
  GatedGrid run;
  Gate limit = gate("position_error");
  test::limit_as<BoundLimit>(limit).max = 0.05, limit.engines = {"b"},
  limit.dt = {{0.05, "0.05"}};  // the cell's is written "1/20"
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
    GatedGrid run;
    Gate limit = gate("position_error");
    test::limit_as<BoundLimit>(limit).min = row.min, test::limit_as<BoundLimit>(limit).equals = row.equals,
    limit.engines = {"a"}, limit.dt = {{0.1, "1/10"}};
    BOOST_TEST((run.check(limit).front().answer == GateAnswer::held) == row.holds);
  }
}

BOOST_AUTO_TEST_CASE(a_bound_that_is_met_exactly_holds) {
  const auto holds = [](double value, const auto& bound) {
    GatedGrid run;
    run.cell(0).metrics["position_error"].value = value;
    Gate limit = gate("position_error");
    limit.engines = {"a"}, limit.dt = {{0.1, "1/10"}};
    bound(limit);
    return run.check(limit).front().answer == GateAnswer::held;
  };
  BOOST_TEST(holds(0.3, [](Gate& gate) { test::limit_as<BoundLimit>(gate).max = 0.3; }));
  BOOST_TEST(holds(0.3, [](Gate& gate) { test::limit_as<BoundLimit>(gate).min = 0.3; }));
  // A rounding is one of what is asked for, and of 1 where that is less.
  BOOST_TEST(holds(0.1 + 0.9 * kRounding, [](Gate& gate) { test::limit_as<BoundLimit>(gate).equals = 0.1; }));
  BOOST_TEST(!holds(0.1 + 1.2 * kRounding, [](Gate& gate) { test::limit_as<BoundLimit>(gate).equals = 0.1; }));
  BOOST_TEST(holds(100 + 90 * kRounding, [](Gate& gate) { test::limit_as<BoundLimit>(gate).equals = 100; }));
  BOOST_TEST(!holds(100 + 120 * kRounding, [](Gate& gate) { test::limit_as<BoundLimit>(gate).equals = 100; }));
}

BOOST_AUTO_TEST_CASE(a_value_that_is_no_number_holds_nowhere) {
  for (const int bound : {0, 1, 2, 3}) {
    GatedGrid run;
    for (Cell& cell : run.result().cells) cell.metrics["position_error"].value = kNan;
    Gate limit = gate("position_error");
    const GateLimit limits[] = {BoundLimit{.max = 0.01}, BoundLimit{.min = 0.01}, BoundLimit{.equals = 0.01},
                                OrderLimit{0.01}};
    limit.limit = limits[bound];
    for (const GateResult& answer : run.check(limit)) BOOST_TEST((answer.answer == GateAnswer::failed));
  }
}

BOOST_AUTO_TEST_CASE(a_gate_that_meets_no_cell_is_not_checked_and_does_not_hold) {
  const auto check = [](GatedGrid& run, const Gate& limit) {
    const auto answers = run.check(limit);
    BOOST_TEST_REQUIRE(answers.size() == 1u);
    BOOST_TEST((answers.front().answer == GateAnswer::not_checked));
    BOOST_TEST(answers.front().text.find("case.toml:7:1") != std::string::npos);
    BOOST_TEST(!all_gates_hold(run.grid));
  };
  GatedGrid other_step, no_metric, unsupported;
  Gate limit = gate("position_error");
  test::limit_as<BoundLimit>(limit).max = 1;
  for (Cell& cell : no_metric.result().cells) cell.metrics["position_error"].not_applicable = "there is no truth";
  check(no_metric, limit);
  for (Cell& cell : unsupported.result().cells) cell.status = Status::unsupported, cell.metrics.clear();
  check(unsupported, limit);
  BOOST_TEST(unsupported.result().gates.front().text.find("where it is asked for") == std::string::npos);
  limit.dt = {{1. / 30, "1/30"}};
  check(other_step, limit);
  other_step.grid.engines.push_back(other_step.grid.engines.front());
  other_step.grid.engines.back().name = "siconos";
  limit.engines = {"siconos"};
  check(other_step, limit);
  BOOST_TEST(other_step.check(limit).front().text.find("siconos runs where it is asked for: --engine siconos") !=
             std::string::npos);
}

// With a selection, a gate is answered by the available cells, or not checked. A missing cell that was selected is
// still a failure.
BOOST_AUTO_TEST_CASE(a_gate_of_other_runs_or_steps_than_were_chosen_is_not_asked) {
  const auto answers = [](const Gate& limit, auto change) {
    GatedGrid chosen;  // of the runs and steps there are, "a" at all steps
    std::erase_if(chosen.result().cells, [](const Cell& cell) { return cell.run != 0; });
    chosen.result().definition.gates = {limit};
    change(chosen);
    check_gates(chosen.result(), chosen.grid, {}, Asked::some);
    return chosen.result().gates;
  };
  const auto as_is = [](GatedGrid&) {};
  const auto at_one_step = [](GatedGrid& chosen) { chosen.result().cells.resize(1); };
  const auto unsupported = [](GatedGrid& chosen) {
    for (Cell& cell : chosen.result().cells) cell.status = Status::unsupported;
  };
  const auto without_the_metric = [](GatedGrid& chosen) {
    for (Cell& cell : chosen.result().cells) cell.metrics.clear();
  };
  Gate limit = gate("position_error"), of_b = limit, ranking = limit, order = limit, spread = gate("spread");
  test::limit_as<BoundLimit>(limit).max = test::limit_as<BoundLimit>(of_b).max =
      test::limit_as<BoundLimit>(spread).max = 1;
  of_b.engines = {"b"};
  test::limit_as<RankingLimit>(ranking).better_than = "b";
  test::limit_as<OrderLimit>(order).at_least = 1;
  BOOST_TEST(count(answers(limit, as_is), GateAnswer::held) > 0);
  BOOST_TEST(answers(of_b, as_is).empty());
  BOOST_TEST(answers(ranking, as_is).empty());
  BOOST_TEST(answers(spread, as_is).empty());
  BOOST_TEST(answers(limit, unsupported).empty());
  BOOST_TEST(count(answers(order, as_is), GateAnswer::held) == 1);
  BOOST_TEST(answers(order, at_one_step).empty());
  BOOST_TEST(count(answers(limit, without_the_metric), GateAnswer::not_checked) == 1);
  const auto one_without = [&](GatedGrid& chosen) { at_one_step(chosen), without_the_metric(chosen); };
  BOOST_TEST(count(answers(limit, one_without), GateAnswer::not_checked) == 1);
  // Both runs of the ranking lack the metric: the gate was checked, and has no answer. If one run cannot have it, the
  // gate was not checked.
  const auto ranked = [&](Status its) {
    return answers(ranking, [&](GatedGrid& chosen) {
      chosen.result().cells = GatedGrid().result().cells;
      for (Cell& cell : chosen.result().cells) {
        cell.metrics.clear();
        if (cell.run == 1) cell.status = its;
      }
    });
  };
  BOOST_TEST(count(ranked(Status::pass), GateAnswer::not_checked) == 1);
  BOOST_TEST(ranked(Status::unsupported).empty());
}

BOOST_AUTO_TEST_CASE(what_no_gate_judged_is_told_from_what_held) {
  GatedGrid run;
  Gate limit = gate("position_error");
  test::limit_as<BoundLimit>(limit).max = 1e9;
  run.check(limit);
  BOOST_TEST(is_any_judged(run.grid));
  test::limit_as<BoundLimit>(limit).max = 1e-9;
  run.check(limit);
  BOOST_TEST(is_any_judged(run.grid));
  run.grid.cases.push_back(run.grid.cases.front());
  run.grid.cases.back().gates.clear();
  BOOST_TEST(is_any_judged(run.grid));  // one case is enough
  run.grid.cases.pop_back();
  limit.metric = "creep";
  run.check(limit);
  BOOST_TEST(!is_any_judged(run.grid));
}

BOOST_AUTO_TEST_CASE(a_cell_without_a_result_fails_every_gate_that_selects_it) {
  for (const Status status : {Status::crashed, Status::timed_out, Status::invalid}) {
    GatedGrid run;
    run.cell(0).status = status, run.cell(0).reason = "it broke", run.cell(0).metrics.clear();
    for (const bool order : {false, true}) {
      Gate limit = gate("position_error");
      limit.limit = order ? GateLimit(OrderLimit{1}) : GateLimit(BoundLimit{.max = 1});
      const auto answers = run.check(limit);
      BOOST_TEST(count(answers, GateAnswer::failed) == 1);
      BOOST_TEST((run.cell(0).status == status));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_blown_up_run_never_passes_a_limit_but_may_be_asked_for) {
  GatedGrid run;
  run.cell(0).status = Status::diverged, run.cell(0).reason = "blown up at 0.1 s: stone";
  Gate limit = gate("position_error");
  limit.engines = {"a"}, limit.dt = {{0.1, "1/10"}}, test::limit_as<BoundLimit>(limit).max = 1e9;
  BOOST_TEST((run.check(limit).front().answer == GateAnswer::failed));
  BOOST_TEST((run.cell(0).status == Status::diverged));
  test::limit_as<BoundLimit>(limit).max = {}, test::limit_as<BoundLimit>(limit).min = 0.001;
  BOOST_TEST((run.check(limit).front().answer == GateAnswer::held));
}

BOOST_AUTO_TEST_CASE(a_blown_up_run_is_never_good_where_more_is_better) {
  GatedGrid run;
  run.cell(0).status = Status::diverged, run.cell(0).reason = "blown up at 0.1 s: stone";
  run.cell(0).metrics["tube"].value = 1;  // until it blew up
  Gate limit = gate("tube");
  limit.engines = {"a"}, limit.dt = {{0.1, "1/10"}}, test::limit_as<BoundLimit>(limit).min = 0.5;
  BOOST_TEST((run.check(limit).front().answer == GateAnswer::failed));
}

BOOST_AUTO_TEST_CASE(a_familys_gate_says_nothing_of_a_case_that_it_does_not_meet_but_of_a_whole_suite) {
  GatedGrid run;
  Gate limit = gate("creep");  // which no cell has
  test::limit_as<BoundLimit>(limit).max = 1, limit.is_of_family = true;
  BOOST_TEST(run.check(limit).empty());
  BOOST_TEST(all_gates_hold(run.grid));
  const auto unmet = unmet_family_gates(run.grid);
  BOOST_TEST_REQUIRE(unmet.size() == 1u);
  BOOST_TEST(unmet.front().where == "case.toml:7:1");
  limit.metric = "position_error", test::limit_as<BoundLimit>(limit).max = 100;
  run.check(limit);
  BOOST_TEST(unmet_family_gates(run.grid).empty());
}

// The stone comes 0.5 m far at 1 m/s in 5 or 10 steps: 8 roundings of 2^-24 of 1 m a step make 1.1e-6 m.
BOOST_AUTO_TEST_CASE(limits_are_wider_for_single_precision_by_its_roundings_and_no_more) {
  Gate limit = gate("position_error");
  test::limit_as<BoundLimit>(limit).max = 1e-9;
  const auto answers_of = [&](double error) {
    GatedGrid run;
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

// A run may continue with steps below its method's order. The result of a gate then says nothing about the method.
BOOST_AUTO_TEST_CASE(a_gate_that_held_over_a_time_of_reduced_order_says_so) {
  GatedGrid fixture;
  Gate limit = gate("position_error"), order = gate("position_error");
  test::limit_as<BoundLimit>(limit).max = 1, test::limit_as<OrderLimit>(order).at_least = 1.9;
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
  test::limit_as<BoundLimit>(cost).max = 1, cost.engines = {"a"}, cost.dt = {{0.1, "1/10"}};
  BOOST_TEST(caveats(cost).empty());
  BOOST_TEST(all_gates_hold(fixture.grid));
}

// A long run is compared until it tells nothing more. Later runs do not qualify the answer.
BOOST_AUTO_TEST_CASE(each_cell_of_an_order_that_was_not_stepped_by_its_own_method_is_named) {
  GatedGrid run;
  Gate order = gate("position_error");
  test::limit_as<OrderLimit>(order).at_least = 1.9, order.engines = {"a"};
  for (std::size_t n = 0; n < 2; ++n) {
    run.cell(n).metrics["position_error"].compared_until = 0.5;
    run.cell(n).reduced_order = ReducedOrder{0.2, "by short steps"};
  }
  const auto answers = run.check(order);
  BOOST_TEST_REQUIRE(answers.size() == 1u);
  BOOST_TEST(answers.front().caveat ==
             "at dt = 1/10 from 0.2 s on stepped by short steps; at dt = 1/20 from 0.2 s on stepped by short steps");
}

// A share has no unit: eight roundings in each of ten steps are 4.8e-6 of it at most.
BOOST_AUTO_TEST_CASE(a_metric_without_unit_is_allowed_roundings_too) {
  Gate limit = gate("energy_drift");
  test::limit_as<BoundLimit>(limit).max = 0, limit.engines = {"b"};
  const auto held = [&](double drift) {
    GatedGrid run;
    run.grid.engines[1].precision = "single";
    for (std::size_t n = 2; n < 4; ++n)
      run.cell(n).metrics["energy_drift"] = run.cell(n).metrics["position_error"],
      run.cell(n).metrics["energy_drift"].value = drift;
    return count(run.check(limit), GateAnswer::held);
  };
  BOOST_TEST(held(1e-7) == 2);
  BOOST_TEST(held(1e-4) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
