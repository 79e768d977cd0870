#include "cases/results/changes.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "cases/gates/gates.h"
#include "cases/metrics/metric.h"
#include "cases/report/json/leave_out_details.h"
#include "core/base/error.h"
#include "tests/cases/judged.h"
#include "tests/cases/limit_as.h"
#include "tests/cases/results/gated_results.h"

using namespace rigor;
using rigor::test::says;

BOOST_AUTO_TEST_SUITE(cases_results_changes)

namespace {

Baseline by_way_of_a_baseline(const Baseline& baseline) {
  const Folder folder;
  return read_baseline(folder.write("baseline.txt", baseline_text(baseline)));
}

Cell& good_cell(Results& grid) { return grid.cases.front().cells.front(); }

// Both by results.json alone and with a baseline for the old one.
template <typename Check>
void both_ways(const Results& before, const Results& after, const Check& check) {
  const Baseline was = outcomes_of(before), is = outcomes_of(after);
  check(changes_between(was, is));
  check(changes_between(by_way_of_a_baseline(was), is));
}

}  // namespace

BOOST_AUTO_TEST_CASE(nothing_has_changed_from_a_result_to_itself) {
  both_ways(gated_results(), gated_results(), [](const Changes& changes) {
    BOOST_TEST(text_of(changes, 1.25) == "nothing changed by more than 1.25 times\nnot worse\n");
    BOOST_TEST(!changes.is_worse());
  });
}

BOOST_AUTO_TEST_CASE(a_worse_verdict_is_worse_and_a_better_one_is_told) {
  const Results stable = gated_results();
  Results gaining = gated_results();
  good_cell(gaining).stability = {Verdict::gaining, 0.5, kWorld, "it rose", 0.13};
  both_ways(stable, gaining, [](const Changes& changes) {
    BOOST_TEST_REQUIRE(changes.newly_failing.size() == 1);
    BOOST_TEST(changes.newly_failing[0] == "family/case, good, 1/10: its verdict is gaining, was stable");
    BOOST_TEST(changes.is_worse());
  });
  both_ways(gaining, stable, [](const Changes& changes) {
    BOOST_TEST(changes.newly_passing.size() == 1);
    BOOST_TEST(!changes.is_worse());
  });
}

BOOST_AUTO_TEST_CASE(a_verdict_that_nobody_knows_is_refused) {
  const Folder folder;
  const std::string file = folder.write("b", R"({"rigor_baseline":2,"metrics":[]}
{"case":"a","engine":"b","dt":"1","status":"pass","verdict":"fine","metrics":{}}
)");
  BOOST_CHECK_EXCEPTION(read_baseline(file), InputError, says("line 2: cell: no such verdict: fine"));
}

BOOST_AUTO_TEST_CASE(an_error_that_grows_beyond_the_factor_is_worse_and_one_that_shrinks_is_told) {
  struct Row {
    double times;
    std::size_t grown, shrunk;
  };
  for (const Row& row : {Row{1.2, 0, 0}, {1.3, 1, 0}, {0.83, 0, 0}, {0.5, 0, 1}}) {
    Results after = gated_results();
    good_cell(after).metrics["position_error"].value *= row.times;
    both_ways(gated_results(), after, [&](const Changes& changes) {
      BOOST_TEST(changes.worse.size() == row.grown);
      BOOST_TEST(changes.better.size() == row.shrunk);
      BOOST_TEST(changes.is_worse() == (row.grown > 0));
    });
  }
}

BOOST_AUTO_TEST_CASE(roundings_are_noise_however_they_grow) {
  Results before = gated_results(), after = gated_results();
  good_cell(before).metrics["position_error"].value = 1e-15;
  good_cell(after).metrics["position_error"].value = 9e-10;
  both_ways(before, after, [](const Changes& changes) { BOOST_TEST(!changes.is_worse()); });
  good_cell(after).metrics["position_error"].value = 2e-9;
  both_ways(before, after, [](const Changes& changes) { BOOST_TEST(changes.worse.size() == 1u); });
}

BOOST_AUTO_TEST_CASE(what_nobody_measured_has_not_changed) {
  Results after = gated_results();
  good_cell(after).metrics["position_error"].not_applicable = "not measured";
  both_ways(gated_results(), after, [](const Changes& changes) {
    BOOST_TEST(changes.better.empty());
    BOOST_TEST(changes.lost.empty());  // which it would be, had it been asked for
  });
}

// A long result says it once, of the case.
BOOST_AUTO_TEST_CASE(nor_has_what_nobody_measured_in_a_case_of_many) {
  Results before = gated_results();
  while (before.cases.size() <= kMostCasesInDetail) {
    before.cases.push_back(before.cases.front());
    before.cases.back().definition.id += std::to_string(before.cases.size());
  }
  const auto lost_where = [&](const std::string& why) {
    Results after = before;
    for (Cell& cell : after.cases.front().cells) {
      if (!cell.metrics.empty()) cell.metrics["position_error"].not_applicable = why;
    }
    return changes_between(outcomes_of(before), outcomes_of(after)).lost.size();
  };
  BOOST_TEST(lost_where("not measured: no gate asks for it") == 0u);
  BOOST_TEST(lost_where("nothing moves") > 0u);
}

// Times are measured anew, and p-values are chance.
BOOST_AUTO_TEST_CASE(costs_and_p_values_are_not_compared) {
  Results before = gated_results(), after = gated_results();
  for (const char* name : {"cost", "ensemble_p_value"}) {
    good_cell(before).metrics[name].value = 1, good_cell(after).metrics[name].value = 100;
    good_cell(before).metrics[name].not_applicable = good_cell(after).metrics[name].not_applicable = "";
  }
  both_ways(before, after, [](const Changes& changes) {
    BOOST_TEST(text_of(changes, 1.25) == "nothing changed by more than 1.25 times\nnot worse\n");
  });
}

BOOST_AUTO_TEST_CASE(each_other_metric_has_a_worse_way_and_a_better_one) {
  for (const MetricRow& row : metrics()) {
    if (row.name == "cost" || row.name == "ensemble_p_value") continue;
    Results low = gated_results(), high = gated_results();
    for (const auto& [grid, value] : {std::pair{&low, 0.3}, {&high, 0.9}}) {
      good_cell(*grid).metrics[row.name].not_applicable = "";
      good_cell(*grid).metrics[row.name].value = row.name == "phase_error" ? -value : value;
    }
    both_ways(low, high, [&](const Changes& c) { BOOST_TEST(c.is_worse() == !row.higher_is_better, row.name); });
    both_ways(high, low, [&](const Changes& c) { BOOST_TEST(c.is_worse() == row.higher_is_better, row.name); });
  }
}

// A shift is as bad to one side as to the other, and what is no number is the worst of either kind.
BOOST_AUTO_TEST_CASE(a_sign_says_nothing_and_what_is_not_finite_is_worst) {
  const auto with = [](const std::string& metric, double value) {
    Results grid = gated_results();
    good_cell(grid).metrics[metric].value = value, good_cell(grid).metrics[metric].not_applicable = "";
    return grid;
  };
  both_ways(with("phase_error", 0.02), with("phase_error", -0.02),
            [](const Changes& changes) { BOOST_TEST(!changes.is_worse()); });
  for (const char* name : {"position_error", "tube"}) {
    const Results good = with(name, 0.9), lost = with(name, std::nan(""));
    both_ways(good, lost, [&](const Changes& changes) { BOOST_TEST(changes.is_worse(), name); });
    both_ways(lost, good, [&](const Changes& changes) { BOOST_TEST(changes.better.size() >= 1u, name); });
  }
}

// Errors of a shorter run are smaller, and say nothing.
BOOST_AUTO_TEST_CASE(a_shorter_run_is_worse_and_its_metrics_are_not_compared) {
  const Results before = gated_results();
  Results shorter = gated_results();
  shorter.cases.front().definition.duration *= 0.5;
  good_cell(shorter).metrics["position_error"].value *= 0.1;
  both_ways(before, shorter, [](const Changes& changes) {
    BOOST_TEST(changes.shorter.size() == 1u);
    BOOST_TEST(changes.better.empty());
    BOOST_TEST(changes.is_worse());
  });
  both_ways(shorter, before, [](const Changes& changes) {
    BOOST_TEST(changes.longer.size() == 1u);
    BOOST_TEST(changes.worse.empty());
    BOOST_TEST(!changes.is_worse());
  });
}

BOOST_AUTO_TEST_CASE(a_smaller_stable_step_is_worse) {
  const auto with = [](double dt) {
    Results grid = gated_results();
    for (StableStepResult& stable : grid.cases.front().stable_steps) stable = {Status::pass, "", {dt, false, false}};
    return grid;
  };
  BOOST_TEST_REQUIRE(!with(0.1).cases.front().stable_steps.empty());
  both_ways(with(0.1), with(0.07), [](const Changes& changes) { BOOST_TEST(changes.is_worse()); });
  both_ways(with(0.1), with(0.09), [](const Changes& changes) { BOOST_TEST(!changes.is_worse()); });
  both_ways(with(0.07), with(0.1), [](const Changes& changes) {
    BOOST_TEST(!changes.better.empty());
    BOOST_TEST(!changes.is_worse());
  });
}

BOOST_AUTO_TEST_CASE(a_regression_that_has_nothing_recorded_is_no_answer) {
  Results grid = sample_results();
  Gate gate;
  gate.metric = "position_error", test::limit_as<RegressionLimit>(gate).factor = 1.25, gate.engines = {"good"};
  grid.cases.front().definition.gates = {gate};
  check_gates(grid.cases.front(), grid);
  BOOST_TEST_REQUIRE(!grid.cases.front().gates.empty());
  BOOST_TEST(outcomes_of(grid).gates.empty());
}

BOOST_AUTO_TEST_CASE(a_case_that_cannot_be_judged_is_worse_and_a_baseline_keeps_it) {
  const Results good = gated_results();
  Results bad = gated_results();
  bad.cases.front().error = "there is no truth";
  both_ways(bad, bad, [](const Changes& changes) { BOOST_TEST(!changes.is_worse()); });
  both_ways(good, bad, [](const Changes& changes) { BOOST_TEST(changes.is_worse()); });
  both_ways(bad, good, [](const Changes& changes) { BOOST_TEST(!changes.newly_passing.empty()); });
}

BOOST_AUTO_TEST_CASE(a_gate_and_its_cell_that_fail_now_are_worse_and_the_other_way_better) {
  both_ways(gated_results(), gated_results(0.1), [](const Changes& changes) {
    BOOST_TEST(changes.newly_failing.size() == 4u);  // two cells and their gates
    BOOST_TEST(changes.is_worse());
  });
  both_ways(gated_results(0.1), gated_results(), [](const Changes& changes) {
    BOOST_TEST(changes.newly_passing.size() == 4u);
    BOOST_TEST(!changes.is_worse());
  });
}

BOOST_AUTO_TEST_CASE(a_cell_that_crashes_or_can_no_longer_run_is_worse) {
  for (const Status status : {Status::crashed, Status::timed_out, Status::diverged, Status::unsupported}) {
    Results after = gated_results();
    good_cell(after).status = status;
    both_ways(gated_results(), after, [](const Changes& changes) { BOOST_TEST(changes.newly_failing.size() == 1u); });
  }
}

BOOST_AUTO_TEST_CASE(settings_that_differ_are_told_and_are_not_worse) {
  Results after = gated_results();
  for (Cell& cell : after.cases.front().cells) cell.settings = {{"solver", "rough"}};
  both_ways(gated_results(), after, [](const Changes& changes) {
    BOOST_TEST(changes.settings.size() == 2u);  // of each engine
    BOOST_TEST(changes.settings.front() == "good, solver: rough, was exact");
    BOOST_TEST(!changes.is_worse());
  });
}

// A setting may have one value in one scene and another in the next: it differs where a value is new.
BOOST_AUTO_TEST_CASE(a_setting_of_several_values_differs_where_one_of_them_is_new) {
  const auto with = [](const char* first, const char* second) {
    Results grid = gated_results();
    auto& cells = grid.cases.front().cells;
    cells[0].settings = {{"solver", first}}, cells[1].settings = {{"solver", second}};
    return grid;
  };
  const Results both = with("exact", "rough");
  const auto differ = [](const Results& before, const Results& after) {
    std::vector<std::vector<std::string>> found;
    both_ways(before, after, [&](const Changes& changes) { found.push_back(changes.settings); });
    BOOST_TEST((found[0] == found[1]));
    return found[0];
  };
  BOOST_TEST(differ(both, with("rough", "rough")).empty());
  BOOST_TEST(differ(both, with("exact", "exact")).empty());
  BOOST_TEST(differ(with("rough", "rough"), both) ==
             std::vector<std::string>{"good, solver: exact | rough, was rough"});
  BOOST_TEST(differ(both, with("exact", "new")) ==
             std::vector<std::string>{"good, solver: exact | new, was exact | rough"});
}

// The worst of several answers to one question counts. An answer over several steps has no cell that would show it.
BOOST_AUTO_TEST_CASE(an_answer_over_several_steps_is_kept_and_the_worst_of_two_counts) {
  const auto with = [](std::vector<GateAnswer> answers) {
    Results grid = gated_results();
    auto& gates = grid.cases.front().gates;
    for (const GateAnswer answer : answers) gates.push_back({0, "good", "", answer, ""});
    return grid;
  };
  using enum GateAnswer;
  const Results good = with({held});
  for (const std::vector<GateAnswer>& answers : {std::vector{failed}, {failed, held}, {held, failed}}) {
    both_ways(good, with(answers), [](const Changes& changes) {
      BOOST_TEST(changes.newly_failing ==
                 std::vector<std::string>{"gate of family/case, position_error, good: failed, was held"});
    });
    both_ways(with(answers), good, [](const Changes& changes) { BOOST_TEST(changes.newly_passing.size() == 1u); });
  }
  both_ways(good, with({known_deviation}), [](const Changes& changes) { BOOST_TEST(!changes.is_worse()); });
  BOOST_TEST(baseline_text(outcomes_of(good)).find("\"answer\":\"held\"") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(each_kind_of_change_has_its_heading_and_its_lines) {
  Changes changes;
  BOOST_TEST(!changes.is_worse());
  changes.newly_failing = {"a"}, changes.newly_passing = {"b", "c"}, changes.worse = {"d"}, changes.better = {"e"};
  changes.lost = {"f"}, changes.shorter = {"g"}, changes.longer = {"h"}, changes.settings = {"i"};
  changes.gone = {"j"}, changes.added = {"k"};
  BOOST_TEST(text_of(changes, 1.25) ==
             "newly failing: 1\n  a\nnewly passing: 2\n  b\n  c\nworse by more than 1.25 times: 1\n  d\n"
             "better by more than 1.25 times: 1\n  e\nno longer measured: 1\n  f\nrun for less time: 1\n  g\n"
             "run for more time: 1\n  h\nsettings that differ: 1\n  i\ngone: 1\n  j\nadded: 1\n  k\nworse\n");
}

BOOST_AUTO_TEST_CASE(a_case_that_is_gone_is_worse_and_one_that_is_new_is_not) {
  Results two = gated_results();
  two.cases.push_back(two.cases.front());
  two.cases.back().definition.id = "family/other";
  both_ways(two, gated_results(), [](const Changes& changes) {
    BOOST_TEST(changes.gone == std::vector<std::string>{"family/other"});
    BOOST_TEST(text_of(changes, 1.25).find("gone") != std::string::npos);
    BOOST_TEST(changes.is_worse());
  });
  both_ways(gated_results(), two, [](const Changes& changes) {
    BOOST_TEST(changes.added == std::vector<std::string>{"family/other"});
    BOOST_TEST(!changes.is_worse());
  });
}

BOOST_AUTO_TEST_CASE(a_cell_that_is_gone_from_a_case_is_worse_and_one_that_is_new_is_not) {
  Results fewer = gated_results();
  fewer.cases.front().cells.erase(fewer.cases.front().cells.begin());
  check_gates(fewer.cases.front(), fewer);
  both_ways(gated_results(), fewer, [](const Changes& changes) {
    BOOST_TEST(changes.gone == std::vector<std::string>{"family/case, good, 1/10"});
    BOOST_TEST(changes.is_worse());
  });
  both_ways(fewer, gated_results(), [](const Changes& changes) {
    BOOST_TEST(changes.added == std::vector<std::string>{"family/case, good, 1/10"});
    BOOST_TEST(!changes.is_worse());
  });
}

BOOST_AUTO_TEST_CASE(an_error_that_is_measured_no_longer_is_worse) {
  Results lost = gated_results(), without_reason = gated_results();
  good_cell(lost).metrics["position_error"].not_applicable = "the truth was not found";
  good_cell(without_reason).metrics.erase("position_error");
  for (const Results& after : {lost, without_reason}) {
    both_ways(gated_results(), after, [](const Changes& changes) {
      BOOST_TEST(changes.lost ==
                 std::vector<std::string>{"family/case, good, 1/10: position_error is missing, was 0.25"});
      BOOST_TEST((changes.worse.empty() && changes.better.empty()));
      BOOST_TEST(text_of(changes, 1.25).find("no longer measured") != std::string::npos);
      BOOST_TEST(changes.is_worse());
    });
  }
}

BOOST_AUTO_TEST_CASE(an_error_that_is_not_finite_is_worse_than_any) {
  for (const double value : {HUGE_VAL, std::nan("")}) {
    Results after = gated_results();
    good_cell(after).metrics["position_error"].value = value;
    both_ways(gated_results(), after, [](const Changes& changes) {
      BOOST_TEST(changes.worse.size() == 1u);
      BOOST_TEST(changes.is_worse());
    });
    both_ways(after, gated_results(), [](const Changes& changes) {
      BOOST_TEST(changes.better.size() == 1u);
      BOOST_TEST(!changes.is_worse());
    });
    both_ways(after, after, [](const Changes& changes) { BOOST_TEST(!changes.is_worse()); });
  }
}

BOOST_AUTO_TEST_CASE(a_cell_that_runs_out_of_time_is_worse_than_one_that_cannot_run) {
  Results before = gated_results(), after = gated_results();
  good_cell(before).status = Status::unsupported, good_cell(after).status = Status::timed_out;
  both_ways(before, after, [](const Changes& changes) { BOOST_TEST(changes.newly_failing.size() == 1u); });
  both_ways(after, before, [](const Changes& changes) { BOOST_TEST(changes.newly_passing.size() == 1u); });
}

BOOST_AUTO_TEST_SUITE_END()
