#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cases/report/json/json_report.h"
#include "cases/report/json/leave_out_details.h"
#include "cases/report/reports.h"
#include "cases/results/result_json.h"
#include "tests/cases/limit_as.h"
#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_json_json_report)

namespace {

constexpr const char* kNotAsked = "not measured: no gate asks for it";

Results many_cases() {
  Results grid = sample_results();
  grid.cases.front().cells.front().metrics["tube"].not_applicable = kNotAsked;
  while (grid.cases.size() <= kMostCasesInDetail) grid.cases.push_back(grid.cases.front());
  return grid;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_reader_finds_every_part_by_its_name) {
  const auto json = nlohmann::json::parse(json_report(sample_results()));
  BOOST_TEST(json.at("schema") == 2);
  for (const char* key : {"cpu", "cores", "compiler", "build_type"}) BOOST_TEST(json.at("machine").contains(key), key);
  BOOST_TEST(json.at("program").contains("version"));
  const auto& one_case = json.at("cases").at(0);
  for (const char* key :
       {"id", "title", "source", "duration", "truth", "gates", "observed_order", "work_precision", "spread"})
    BOOST_TEST(one_case.contains(key), key);
  BOOST_TEST(json.at("cells").size() == 4u);
  const auto& cell = json.at("cells").at(0);
  BOOST_TEST(cell.at("case") == "family/case");
  BOOST_TEST(cell.at("engine") == "good");
  BOOST_TEST(cell.at("dt") == "1/10");
  BOOST_TEST(cell.at("dt_seconds") == 0.1);
  BOOST_TEST(cell.at("status") == "pass");
  BOOST_TEST(cell.at("verdict").at("word") == "stable");
  BOOST_TEST(cell.at("verdict").at("phrase") == "stable");
  BOOST_TEST(json.at("cases").at(0).at("size").get<double>() == 2.45, boost::test_tools::tolerance(1e-3));
  BOOST_TEST(cell.at("settings").at("solver") == "exact");
  BOOST_TEST(cell.at("trajectory") == "t0.csv");
  const auto& error = cell.at("metrics").at("position_error");
  BOOST_TEST(error.at("value") == 0.25);
  BOOST_TEST(error.at("unit") == "m");
  BOOST_TEST(error.at("compared_until") == 0.5);
  BOOST_TEST(error.at("worst").at("time") == 0.3);
  BOOST_TEST(error.at("worst").at("body") == "st|one \"1\", <i>");
  BOOST_TEST(error.at("worst").at("component") == "position.y");
  BOOST_TEST(error.at("worst").at("found") == 2);
  BOOST_TEST(error.at("worst").at("expected") == 1.75);
  BOOST_TEST(cell.at("metrics").at("energy_drift").at("worst").at("body") == "world");
  BOOST_TEST(cell.at("metrics").at("orientation_error").at("not_applicable") == "nothing turns");
  BOOST_TEST(json.at("stable_dt").at(0).at("dt") == 0.0678);
  BOOST_TEST(json.at("stable_dt").at(1).at("dt").is_null());
}

// A long result must contain everything that `rigor compare` reads.
BOOST_AUTO_TEST_CASE(of_many_cases_every_cell_keeps_its_values_and_leaves_out_its_details) {
  const Results grid = many_cases();
  const nlohmann::json full = results_json(grid), told = nlohmann::json::parse(json_report(grid));
  BOOST_TEST(told.at("cells").size() == full.at("cells").size());
  for (std::size_t i = 0; i < told.at("cells").size(); ++i) {
    const auto &brief = told.at("cells").at(i), &cell = full.at("cells").at(i);
    // The value as text: a non-finite value, or a value that is no text, equals nothing.
    for (const char* key : {"case", "engine", "dt", "status", "reason", "trajectory"})
      BOOST_TEST(text_of(brief.at(key), -1) == text_of(cell.at(key), -1), key);
    auto verdict = cell.at("verdict");
    if (!verdict.is_null() && verdict.at("word") == "stable") verdict["why"] = "";
    BOOST_TEST(text_of(brief.at("verdict"), -1) == text_of(verdict, -1));
    const auto& holder =
        brief.contains("settings_of") ? told.at("cells").at(brief.at("settings_of").get<std::size_t>()) : brief;
    BOOST_TEST(holder.at("settings") == cell.at("settings"));
    for (const auto& [name, metric] : cell.at("metrics").items()) {
      const bool is_told = metric.contains("value") || metric.at("not_applicable") == kNotAsked;
      BOOST_TEST(brief.at("metrics").contains(name) == is_told, name);
      if (!metric.contains("value")) continue;
      BOOST_TEST(brief.at("metrics").at(name).size() == 1u);
      BOOST_TEST(text_of(brief.at("metrics").at(name).at("value"), -1) == text_of(metric.at("value"), -1), name);
    }
  }
  BOOST_TEST(told.at("cells").at(1).at("settings_of") == 0u);
}

BOOST_AUTO_TEST_CASE(only_a_held_gate_says_nothing_more_among_many_cases) {
  Results grid = many_cases();
  grid.cases[0].definition.gates.resize(1);
  grid.cases[0].gates = {{0, "good", "1/10", GateAnswer::held, "0.1 m, at most 0.2 m", 0.1},
                         {0, "wild", "1/10", GateAnswer::failed, "0.3 m, at most 0.2 m", 0.3}};
  const auto told = nlohmann::json::parse(json_report(grid));
  const auto& answers = told.at("cases").at(0).at("gates").at(0).at("answers");
  BOOST_TEST(
      (!answers.at(0).contains("text") && !answers.at(0).contains("value") && !answers.at(0).contains("caveat")));
  BOOST_TEST(answers.at(1).at("value") == 0.3);
  BOOST_TEST(answers.at(1).at("text") == "0.3 m, at most 0.2 m");
}

BOOST_AUTO_TEST_CASE(among_many_cases_a_gate_names_the_limits_that_it_has) {
  Results grid = many_cases();
  grid.cases[0].definition.gates.resize(1);
  const auto full = results_json(grid).at("cases").at(0).at("gates").at(0);
  const auto told = nlohmann::json::parse(json_report(grid)).at("cases").at(0).at("gates").at(0);
  for (const auto& [key, value] : full.items()) BOOST_TEST(told.contains(key) == !value.is_null(), key);
}

// As a result of few cases has it in each cell.
BOOST_AUTO_TEST_CASE(what_no_cell_of_a_case_was_asked_for_stands_with_the_case) {
  Results grid = many_cases();
  for (Cell& cell : grid.cases[0].cells) {
    if (!cell.metrics.empty()) cell.metrics["tube"].not_applicable = kNotAsked;
  }
  grid.cases[0].definition.id = "family/first";
  const auto told = nlohmann::json::parse(json_report(grid));
  BOOST_TEST(told.at("cases").at(0).at("not_measured") == nlohmann::json({"tube"}));
  BOOST_TEST(!told.at("cases").at(1).contains("not_measured"));  // of these one cell alone was not asked
  for (const auto& cell : told.at("cells")) {
    if (cell.at("case") == "family/first") BOOST_TEST(!cell.at("metrics").contains("tube"));
  }
  BOOST_TEST(told.at("cells").at(4).at("metrics").at("tube").at("not_applicable") == "not measured");
}

BOOST_AUTO_TEST_CASE(stable_steps_that_nobody_asked_for_are_no_rows_among_many_cases) {
  Results grid = many_cases();
  skip(grid.cases[0].stable_steps[1], SkipReason::not_asked_for);
  const auto all = results_json(grid).at("stable_dt"),
             told = nlohmann::ordered_json::parse(json_report(grid)).at("stable_dt");
  BOOST_TEST(all.size() == 2 * grid.cases.size());
  BOOST_TEST(told.size() == 2 * grid.cases.size() - 1);
  BOOST_TEST(told.at(0).at("dt") == 0.0678);
  BOOST_TEST(told.at(2).at("reason") == "no result");  // one that was asked for and not found stays
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_has_a_word_and_what_is_not_text_is_no_trouble) {
  const auto json = nlohmann::json::parse(json_report(sample_results()));
  BOOST_TEST(json.at("cells").at(2).at("metrics").at("position_error").at("value") == "inf");
  const auto& crashed = json.at("cells").at(3);
  BOOST_TEST(crashed.at("status") == "crashed");
  BOOST_TEST(crashed.at("verdict").is_null());
  BOOST_TEST(crashed.at("trajectory").is_null());
  BOOST_TEST(crashed.at("reason").get<std::string>().find("SIGSEGV") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_message_brings_back_the_cell_that_was_sent) {
  using Part = MessageSubject::Part;
  const Results sent = sample_results();
  const Scene& scene = sent.cases.front().definition.scene;
  CaseResult received = sent.cases.front();
  for (Cell& cell : received.cells) {
    Cell blank;
    blank.run = cell.run, blank.dt = cell.dt;
    cell = blank;
  }
  for (std::size_t i = 0; i < received.cells.size(); ++i) {
    const Cell& cell = sent.cases.front().cells[i];
    BOOST_TEST((apply_message(received, message_of_cell(i, cell, scene)) == MessageSubject{Part::cell, i}));
    BOOST_TEST(received.cells[i].run == cell.run);
  }
  // Against what sample_results.h says, by hand: the writer is not asked what it wrote.
  const Cell& good = received.cells[0];
  BOOST_TEST((good.status == Status::pass && good.reason.empty() && good.trajectory == "t0.csv"));
  BOOST_TEST((good.stability.verdict == Verdict::stable));
  BOOST_TEST((good.settings == SettingsInForce{{"solver", "exact"}}));
  const MetricValue& error = good.metrics.at("position_error");
  BOOST_TEST((error.value == 0.25 && error.first_second == 0.125 && error.compared_until == 0.5));
  BOOST_TEST((error.worst.time == 0.3 && error.worst.body == 0 && error.worst.component == "position.y"));
  BOOST_TEST((error.worst.found == 2 && error.worst.expected == 1.75));
  BOOST_TEST(good.metrics.at("energy_drift").worst.body == kWorld);
  BOOST_TEST(good.metrics.at("orientation_error").not_applicable == "nothing turns");
  BOOST_TEST(good.metrics.size() == 4u);
  BOOST_TEST(good.scheme.twin == "core:its-twin");
  BOOST_TEST(good.scheme.metrics.at("position_error").value == 0.24);
  const Cell& blown_up = received.cells[2];
  BOOST_TEST((blown_up.status == Status::diverged && blown_up.stability.verdict == Verdict::blown_up));
  BOOST_TEST((blown_up.stability.time == 0.4 && blown_up.stability.body == 0));
  BOOST_TEST(blown_up.stability.why == "its numbers are not finite");
  BOOST_TEST(!std::isfinite(blown_up.metrics.at("position_error").value));
  BOOST_TEST((received.cells[3].status == Status::crashed && received.cells[3].metrics.empty()));
  BOOST_TEST(received.cells[3].reason.starts_with("killed by SIGSEGV; its last words: "));
  BOOST_TEST((apply_message(received, message_of_truth({1, 2, 3})) == MessageSubject{Part::truth}));
  BOOST_TEST(received.truth->horizon == 2);
  Spread spread{0, 1, {0.1, "1/10"}, {0.5, 0.25, 0}, {0.125, 0.375, 0}, 0.0625, 2};
  Spread together{1, 0, {0.05, "1/20"}, {}, {}, {}, 3};
  BOOST_TEST((apply_message(received, message_of_spreads({spread, together})) == MessageSubject{Part::spreads}));
  BOOST_TEST_REQUIRE(received.spreads.size() == 2u);
  const Spread& back = received.spreads.front();
  BOOST_TEST((back.first == 0 && back.second == 1 && back.dt.seconds == 0.1 && back.dt.text == "1/10"));
  BOOST_TEST((back.distance.value == 0.5 && back.distance.time == 0.25 && back.distance.body == 0));
  BOOST_TEST((back.angle.value == 0.125 && back.angle.time == 0.375));
  BOOST_TEST((back.parted_at == 0.0625 && back.compared_until == 2));
  BOOST_TEST(!received.spreads.back().parted_at.has_value());
  const std::string stable = message_of_stable_step(1, {Status::pass, "", {0.5, true, false}});
  BOOST_TEST((apply_message(received, stable) == MessageSubject{Part::stable_step, 1}));
  BOOST_TEST(received.stable_steps[1].step.is_cap);
}

BOOST_AUTO_TEST_CASE(a_gate_says_what_it_asks_and_of_what_kind_it_is) {
  Results results = sample_results();
  CaseResult& result = results.cases.front();
  Gate limit, regression, order;
  limit.metric = "position_error", test::limit_as<BoundLimit>(limit).max = 0.5, limit.because = "half a metre",
  limit.where = "c:7:1";
  regression.metric = "creep", test::limit_as<RegressionLimit>(regression).factor = 1.25;
  order.metric = "energy_drift", test::limit_as<OrderLimit>(order).at_least = 0.1,
  test::limit_as<OrderLimit>(order).is_declared = true;
  result.definition.gates = {limit, regression, order};
  result.gates = {{0, "good", "1/10", GateAnswer::held, "it is", 0.25},
                  {1, "good", "1/20", GateAnswer::not_recorded, "n"}};
  const auto json = nlohmann::json::parse(json_report(results));
  const auto& gates = json.at("cases").at(0).at("gates");
  BOOST_TEST(gates.size() == 3u);
  BOOST_TEST(gates.at(0).at("kind") == "bound");
  BOOST_TEST(gates.at(0).at("max") == 0.5);
  BOOST_TEST(gates.at(0).at("min").is_null());
  BOOST_TEST(gates.at(0).at("where") == "c:7:1");
  BOOST_TEST(gates.at(0).at("answers").at(0).at("value") == 0.25);
  BOOST_TEST(gates.at(0).at("answers").at(0).at("answer") == "held");
  BOOST_TEST(gates.at(1).at("kind") == "regression");
  BOOST_TEST(gates.at(1).at("regression") == 1.25);
  BOOST_TEST(gates.at(1).at("answers").at(0).at("answer") == "not recorded");
  BOOST_TEST(gates.at(1).at("answers").at(0).at("value").is_null());
  BOOST_TEST(gates.at(2).at("at_least_order") == "declared");
  BOOST_TEST(json.at("cells").at(0).at("gates").at(0).at("gate") == 0);
  BOOST_TEST(json.at("cells").at(1).at("gates").at(0).at("gate") == 1);
}

BOOST_AUTO_TEST_SUITE_END()
