#include "cases/gates/regression.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "cases/gates/failures.h"
#include "cases/gates/gates.h"
#include "cases/report/json/leave_out_details.h"
#include "cases/report/reports.h"
#include "core/base/error.h"
#include "tests/cases/limit_as.h"
#include "tests/cases/report/sample_results.h"
#include "tests/core/scene/toml/refusal.h"
#include "tests/folder.h"

using namespace rigor;

namespace cases_gates_regression {

// The sample's grid: position_error is .25 in both cells of "good"; of "wild" one blew up and one crashed.
struct Fixture : Folder {
  Results grid = sample_results();
  CaseResult& result() { return grid.cases.front(); }

  RecordedValues recorded(const std::string& text) const {
    write("adapters/good/regression.jsonl", text);
    return read_recorded_values((path / "adapters").string(), grid.engines);
  }
  std::string word_with(double value, double factor) {
    RecordedValues values;
    values.add("family/case", grid.runs[0], 0.1, "position_error", value);
    Gate gate;
    gate.metric = "position_error", test::limit_as<RegressionLimit>(gate).factor = factor, gate.engines = {"good"},
    gate.dt = {{0.1, "0.1"}};
    result().definition.gates = {gate};
    check_gates(result(), grid, values);
    return word_of(result().gates.front().answer);
  }
};

const std::string kLine =
    "{\"case\":\"family/case\",\"run\":\"good\",\"dt\":\"1/10\",\"position_error\":0.25,\"energy_drift\":0.5}\n";

}  // namespace cases_gates_regression

BOOST_FIXTURE_TEST_SUITE(cases_gates_regression, Fixture)

BOOST_AUTO_TEST_CASE(a_value_is_held_within_the_factor_of_the_recorded_one_either_way) {
  BOOST_TEST(word_with(0.25, 1.25) == "held");
  BOOST_TEST(word_with(0.25 / 1.24, 1.25) == "held");
  BOOST_TEST(word_with(0.25 / 1.26, 1.25) == "failed");  // it got worse
  BOOST_TEST(word_with(0.25 * 1.24, 1.25) == "held");
  BOOST_TEST(word_with(0.25 * 1.26, 1.25) == "failed");  // better: to be recorded anew
  BOOST_TEST(word_with(0, 1.25) == "failed");
}

BOOST_AUTO_TEST_CASE(roundings_are_no_change_and_what_is_no_number_is_one) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  BOOST_TEST(change_from(0, 9e-10, 1.25) == "");
  BOOST_TEST(change_from(0, 1.1e-9, 1.25) != "");
  BOOST_TEST(change_from(1e-3, nan, 1.25) != "");
  BOOST_TEST(change_from(1e-3, inf, 1.25) != "");
  BOOST_TEST(change_from(nan, 1e-3, 1.25) != "");
}

BOOST_AUTO_TEST_CASE(a_cell_without_a_recorded_value_is_said_to_have_none_and_the_gate_that_met_none_is_held_by_it) {
  Gate gate;
  gate.metric = "position_error", test::limit_as<RegressionLimit>(gate).factor = 1.25;
  result().definition.gates = {gate};
  check_gates(result(), grid, recorded(kLine));
  std::map<std::string, int> counts;
  for (const GateResult& answer : result().gates) ++counts[word_of(answer.answer)];
  BOOST_TEST(counts["held"] == 1);
  BOOST_TEST(counts["not recorded"] == 2);  // the other step, and the run that blew up
  BOOST_TEST(counts["failed"] == 1);        // the one that crashed, whatever is recorded
  for (const GateResult& answer : result().gates) {
    if (answer.engine == "wild" && answer.answer == GateAnswer::not_recorded) BOOST_TEST(!answer.value.has_value());
  }
}

// ODE's direct solver gives up on some scenes: no value then, but one that is recorded has to come again.
BOOST_AUTO_TEST_CASE(an_invalid_cell_fails_only_where_a_value_is_recorded) {
  Gate gate;
  gate.metric = "position_error", test::limit_as<RegressionLimit>(gate).factor = 1.25, gate.engines = {"good"},
  gate.dt = {{0.1, "1/10"}};
  result().definition.gates = {gate};
  result().cells[0].status = Status::invalid;
  check_gates(result(), grid);
  BOOST_TEST((result().gates.front().answer == GateAnswer::not_recorded));
  const auto of_cell = [](const Failure& row) { return row.engine == "good"; };
  auto rows = failures(grid);
  BOOST_TEST(std::none_of(rows.begin(), rows.end(), of_cell));
  check_gates(result(), grid, recorded(kLine));
  BOOST_TEST((result().gates.front().answer == GateAnswer::failed));
  rows = failures(grid);
  BOOST_TEST(std::count_if(rows.begin(), rows.end(), of_cell) == 2);  // as a cell and for its gate
}

BOOST_AUTO_TEST_CASE(a_run_that_blew_up_does_not_hold_what_is_recorded) {
  RecordedValues values;
  values.add("family/case", grid.runs[1], 0.1, "energy_drift", 0.5);
  Gate gate;
  gate.metric = "energy_drift", test::limit_as<RegressionLimit>(gate).factor = 1.25, gate.engines = {"wild"},
  gate.dt = {{0.1, "1/10"}};
  result().definition.gates = {gate};
  check_gates(result(), grid, values);
  BOOST_TEST((result().gates.front().answer == GateAnswer::failed));
}

BOOST_AUTO_TEST_CASE(a_rounding_is_recorded_as_none) {
  Gate gate;
  gate.metric = "position_error", test::limit_as<RegressionLimit>(gate).factor = 1.25, gate.dt = {{0.1, "0.1"}};
  result().definition.gates = {gate};
  for (Cell& cell : result().cells) cell.metrics["position_error"].value = 1e-12;
  check_gates(result(), grid);
  BOOST_TEST(regression_text(write("results.json", json_report(grid)), "good").text ==
             "{\"case\":\"family/case\",\"run\":\"good\",\"dt\":\"1/10\",\"position_error\":0.0}\n");
}

BOOST_AUTO_TEST_CASE(the_file_made_of_results_holds_them) {
  Gate gate, bound;
  gate.metric = "position_error", test::limit_as<RegressionLimit>(gate).factor = 1.25;
  bound.metric = "energy_drift", test::limit_as<BoundLimit>(bound).max = 1;
  result().definition.gates = {gate, bound};
  check_gates(result(), grid);
  const RegressionText made = regression_text(write("results.json", json_report(grid)), "good");
  BOOST_TEST(made.text ==
             "{\"case\":\"family/case\",\"run\":\"good\",\"dt\":\"1/10\",\"position_error\":0.25}\n"
             "{\"case\":\"family/case\",\"run\":\"good\",\"dt\":\"1/20\",\"position_error\":0.25}\n");
  BOOST_TEST(made.left_out == 0);
  result().gates.clear();
  check_gates(result(), grid, recorded(made.text));
  for (const GateResult& answer : result().gates) {
    if (answer.engine == "good") BOOST_TEST((answer.answer == GateAnswer::held), answer.text);
  }
  BOOST_CHECK_THROW(regression_text((path / "results.json").string(), "wild"), InputError);  // it has no value
}

// A long result leaves out what stands twice; not what is recorded.
BOOST_AUTO_TEST_CASE(the_file_made_of_a_long_result_holds_values_that_held) {
  Gate gate;
  gate.metric = "position_error", test::limit_as<RegressionLimit>(gate).factor = 1.25;
  result().definition.gates = {gate};
  check_gates(result(), grid, recorded(kLine));
  for (std::size_t n = 0; n < kMostCasesInDetail; ++n) {
    grid.cases.push_back(grid.cases.front());
    grid.cases.back().definition.id = fmt::format("family/other {}", n);
  }
  const RegressionText made = regression_text(write("results.json", json_report(grid)), "good");
  BOOST_TEST(
      made.text.starts_with("{\"case\":\"family/case\",\"run\":\"good\",\"dt\":\"1/10\",\"position_error\":0.25}\n"),
      made.text);
  BOOST_TEST(static_cast<std::size_t>(std::count(made.text.begin(), made.text.end(), '\n')) == 2 * grid.cases.size());
}

BOOST_AUTO_TEST_CASE(a_line_that_is_none_is_refused_with_its_place) {
  const std::pair<std::string, std::string> rows[] = {
      {"{\"case\": \"a\",\n", ":1:"},
      {kLine + "[1]\n", ":2:1: is no JSON object"},
      {kLine + "\n", ":2:1: is not JSON"},
      {"{\"run\":\"good\",\"dt\":\"1\"}\n", ":1:1: case: missing"},
      {"{\"case\":\"a\",\"run\":\"god\",\"dt\":\"1\"}\n", ":1:1: run: "},
      {"{\"case\":\"a\",\"run\":\"god\",\"dt\":\"1\"}\n", "did you mean 'good'?"},
      {"{\"case\":\"a\",\"run\":\"wild\",\"dt\":\"1\"}\n", ":1:1: run: found 'wild'; allowed: runs of good"},
      {"{\"case\":\"a\",\"run\":\"good\",\"dt\":\"x\"}\n", ":1:1: dt"},
      {"{\"case\":\"a\",\"run\":\"good\",\"dt\":1}\n", ":1:1: dt: found 1"},
      {"{\"case\":\"a\",\"run\":\"good\",\"dt\":\"1\",\"crep\":1}\n", "did you mean 'creep'?"},
      {"{\"case\":\"a\",\"run\":\"good\",\"dt\":\"1\",\"creep\":null}\n", "creep: found null"},
      {kLine + kLine, ":2:1: position_error of family/case, good, dt = 1/10 is given twice"},
  };
  for (const auto& [text, part] : rows) {
    const std::string refusal = refusal_of([&] { recorded(text); });
    BOOST_TEST(refusal.find(part) != std::string::npos, text << ": " << refusal);
    BOOST_TEST(refusal.find("good/regression.jsonl") != std::string::npos, refusal);
  }
}

BOOST_AUTO_TEST_CASE(a_run_and_a_step_are_the_same_however_they_are_written) {
  const RecordedValues values =
      recorded("{\"case\":\"family/case\",\"run\":\"good:only\",\"dt\":\"0.1\",\"creep\":1}\n");
  BOOST_TEST(values.find("family/case", grid.runs[0], 0.1, "creep").value_or(0) == 1);
  BOOST_TEST(!values.find("family/case", grid.runs[0], 0.05, "creep").has_value());
  BOOST_TEST(!values.find("family/case", grid.runs[1], 0.1, "creep").has_value());
}

BOOST_AUTO_TEST_CASE(a_file_that_is_no_results_is_refused) {
  for (const char* text : {"{}", "[]", "{\"engines\": 1, \"cases\": []}", "no JSON"}) {
    const std::string file = write("other.json", text);
    BOOST_CHECK_EXCEPTION(regression_text(file, "good"), InputError, [&](const InputError& error) {
      return std::string(error.what()).find(file) != std::string::npos;
    });
  }
}

// An answer by a run that the file does not list belongs to no engine.
BOOST_AUTO_TEST_CASE(an_answer_of_an_unlisted_run_is_recorded_for_no_engine) {
  Gate gate;
  gate.metric = "position_error", test::limit_as<RegressionLimit>(gate).factor = 1.25;
  result().definition.gates = {gate};
  check_gates(result(), grid);
  for (GateResult& answer : result().gates) answer.engine = "nobody";
  const std::string file = write("results.json", json_report(grid));
  for (const char* engine : {"good", "nobody"}) BOOST_CHECK_THROW(regression_text(file, engine), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
