#include "cases/gates/deviations.h"

#include <boost/test/unit_test.hpp>

#include "cases/case/suite.h"
#include "cases/gates/gates.h"
#include "core/base/error.h"
#include "tests/cases/judged.h"
#include "tests/cases/limit_as.h"
#include "tests/cases/runner/faulty_engine.h"
#include "tests/cases/vocabulary.h"
#include "tests/folder.h"

using namespace rigor;
using rigor::test::says;

BOOST_AUTO_TEST_SUITE(cases_gates_deviations)

namespace {

const std::vector<EngineInfo>& infos() {
  static const std::vector<EngineInfo> all = infos_of(engines());
  return all;
}

constexpr const char* kRow = R"([[deviation]]
case    = "drift"
gate    = "position_error"
engines = ["ode"]
dt      = ["1/10"]
reason  = "it slips"
)";

std::vector<KnownDeviation> read(const std::string& text) {
  const Folder folder;
  folder.write("ode/known_deviations.toml", text);
  return read_known_deviations(folder.path.string(), infos());
}

// Two cells of ODE under one limit of 1 m: `errors` at dt = 1/10 and 1/20.
Results judged(double coarse, double fine, const std::vector<KnownDeviation>& rows) {
  Results grid;
  grid.engines = infos();
  grid.runs = {parse_run_name("ode", infos())};
  CaseResult result;
  result.definition = drifting_body("drift");
  Gate gate;
  gate.metric = "position_error", test::limit_as<BoundLimit>(gate).max = 1, gate.because = "a reason",
  gate.where = "drift.toml:7:1";
  result.definition.gates = {gate};
  for (std::size_t i = 0; i < 2; ++i) {
    Cell cell;
    cell.dt = result.definition.dt[i], cell.status = Status::pass, cell.reason = "";
    cell.metrics["position_error"].value = i == 0 ? coarse : fine;
    result.cells.push_back(cell);
  }
  grid.cases = {result};
  check_gates(grid.cases.front(), grid);
  apply_known_deviations(grid.cases.front(), grid, rows);
  return grid;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_failure_that_is_known_lets_the_gate_hold) {
  const Results grid = judged(2, 0.5, read(kRow));
  const CaseResult& result = grid.cases.front();
  BOOST_TEST(word_of(result.cells[0].status) == "known-deviation");
  BOOST_TEST(word_of(result.cells[1].status) == "pass");
  BOOST_TEST(result.cells[0].reason.find("it slips") != std::string::npos);
  BOOST_TEST(all_gates_hold(grid));
}

BOOST_AUTO_TEST_CASE(one_that_is_not_known_still_fails) {
  const Results grid = judged(2, 2, read(kRow));
  BOOST_TEST(word_of(grid.cases.front().cells[1].status) == "fail");
  BOOST_TEST(!all_gates_hold(grid));
}

BOOST_AUTO_TEST_CASE(a_pass_that_nobody_expected_fails_until_the_row_goes) {
  const Results grid = judged(0.5, 0.5, read(kRow));
  BOOST_TEST(word_of(grid.cases.front().cells[0].status) == "unexpected-pass");
  BOOST_TEST(grid.cases.front().cells[0].reason.find("known_deviations.toml:1:1") != std::string::npos);
  BOOST_TEST(!all_gates_hold(grid));
}

BOOST_AUTO_TEST_CASE(a_row_without_steps_speaks_of_all) {
  std::string text = kRow;
  text.erase(text.find("dt "), std::string("dt      = [\"1/10\"]\n").size());
  BOOST_TEST(all_gates_hold(judged(2, 2, read(text))));
  BOOST_TEST(!all_gates_hold(judged(2, 0.5, read(text))));  // the row says more than is true
}

BOOST_AUTO_TEST_CASE(what_is_mistyped_is_refused_with_its_place) {
  const auto with = [](const std::string& part, const std::string& instead) {
    std::string text = kRow;
    return text.replace(text.find(part), part.size(), instead);
  };
  BOOST_CHECK_EXCEPTION(read(with("reason", "resaon")), InputError, says("resaon"));
  BOOST_CHECK_EXCEPTION(read(with("position_error", "positon_error")), InputError, says("position_error"));
  BOOST_CHECK_EXCEPTION(read(with("\"ode\"", "\"bullet\"")), InputError, says("runs of ode"));
  BOOST_CHECK_EXCEPTION(read(with("\"ode\"", "\"oed\"")), InputError, says("known_deviations.toml:4:"));
  BOOST_CHECK_EXCEPTION(read(with("1/10", "ten")), InputError, says("ten"));
  BOOST_CHECK_EXCEPTION(read_known_deviations("/no/such/folder", infos()), InputError, says("no such folder"));
}

BOOST_AUTO_TEST_CASE(a_row_that_no_gate_can_meet_is_refused) {
  Case definition = drifting_body("drift");
  const auto rows = read(kRow);
  BOOST_CHECK_EXCEPTION(check_known_deviations(rows, {definition}, infos()), InputError, says("no gate of drift"));
  Gate gate;
  gate.metric = "position_error", gate.engines = {"ode"};
  definition.gates = {gate};
  check_known_deviations(rows, {definition}, infos());
  definition.gates.front().engines = {"bullet"};
  BOOST_CHECK_THROW(check_known_deviations(rows, {definition}, infos()), InputError);
  definition.id = "another";  // not selected: nothing to say
  check_known_deviations(rows, {definition}, infos());
}

// Each of what a gate has to share with a row to be met by it.
BOOST_AUTO_TEST_CASE(a_gate_of_another_metric_or_step_or_a_regression_is_none_that_a_row_meets) {
  const auto check = [](const auto& change) {
    Case definition = drifting_body("drift");
    Gate gate;
    gate.metric = "position_error", test::limit_as<BoundLimit>(gate).max = 1, gate.engines = {"ode"};
    change(gate);
    definition.gates = {gate};
    check_known_deviations(read(kRow), {definition}, infos());
  };
  check([](Gate&) {});
  BOOST_CHECK_THROW(check([](Gate& gate) { gate.metric = "energy_drift"; }), InputError);
  BOOST_CHECK_THROW(check([](Gate& gate) {
                      test::limit_as<BoundLimit>(gate).max = {}, test::limit_as<RegressionLimit>(gate).factor = 1.25;
                    }),
                    InputError);
  BOOST_CHECK_THROW(check([](Gate& gate) { gate.dt = {{0.05, "1/20"}}; }), InputError);
}

// One over all steps of a run is spoken of by a row that names no steps.
BOOST_AUTO_TEST_CASE(an_answer_without_a_step_is_known_by_a_row_without_steps) {
  for (const bool names_step : {false, true}) {
    std::string text = kRow;
    if (!names_step) text.erase(text.find("dt "), std::string("dt      = [\"1/10\"]\n").size());
    Results grid = judged(0.5, 0.5, {});
    CaseResult& result = grid.cases.front();
    result.gates.front().dt = "", result.gates.front().answer = GateAnswer::failed;
    result.gates.resize(1);
    apply_known_deviations(result, grid, read(text));
    BOOST_TEST((result.gates.front().answer == (names_step ? GateAnswer::failed : GateAnswer::known_deviation)));
    for (const Cell& cell : result.cells) BOOST_TEST(word_of(cell.status) == "pass");  // it is no answer of one cell
  }
}

BOOST_AUTO_TEST_CASE(a_row_of_another_case_metric_or_run_says_nothing) {
  const auto with = [](const std::string& part, const std::string& instead) {
    std::string text = kRow;
    return text.replace(text.find(part), part.size(), instead);
  };
  for (const std::string& text :
       {with("\"drift\"", "\"another\""), with("position_error", "energy_drift"), with("\"ode\"", "\"ode:quickstep\"")})
    BOOST_TEST(word_of(judged(2, 0.5, read(text)).cases.front().cells[0].status) == "fail", text);
}

BOOST_AUTO_TEST_CASE(a_cell_counts_as_what_is_worst_among_its_answers) {
  Results grid = judged(2, 0.5, read(kRow));
  CaseResult& result = grid.cases.front();
  GateResult unexpected = result.gates.front(), failed = unexpected;
  unexpected.answer = GateAnswer::unexpected_pass, unexpected.text = "it held";
  failed.answer = GateAnswer::failed, failed.text = "it failed";
  const auto concluded = [&](std::vector<GateResult> more) {
    result.cells[0].status = Status::pass;
    result.gates.resize(1);  // which is a known deviation
    result.gates.insert(result.gates.end(), more.begin(), more.end());
    apply_known_deviations(result, grid, {});
    return word_of(result.cells[0].status) + ": " + result.cells[0].reason;
  };
  BOOST_TEST(concluded({}).starts_with("known-deviation: "));
  BOOST_TEST(concluded({unexpected}) == "unexpected-pass: it held");
  BOOST_TEST(concluded({unexpected, failed}) == "fail: it failed");
  failed.engine = "ode:quickstep";  // of another run
  BOOST_TEST(concluded({failed}).starts_with("known-deviation: "));
  result.cells[0].status = Status::diverged;
  apply_known_deviations(result, grid, {});
  BOOST_TEST((result.cells[0].status == Status::diverged));
}

BOOST_AUTO_TEST_CASE(a_row_without_runs_is_of_its_engine_and_a_step_may_be_a_number) {
  std::string text = kRow;
  text.erase(text.find("engines"), std::string("engines = [\"ode\"]\n").size());
  text.replace(text.find("\"1/10\""), 6, "0.1");
  const auto rows = read(text);
  BOOST_TEST_REQUIRE(rows.size() == 1u);
  BOOST_TEST_REQUIRE(rows[0].runs.size() == 1u);
  BOOST_TEST((rows[0].runs[0].engine == "ode" && rows[0].runs[0].text == "ode"));
  BOOST_TEST(word_of(judged(2, 0.5, rows).cases.front().cells[0].status) == "known-deviation");
}

BOOST_AUTO_TEST_CASE(a_row_of_several_runs_is_met_by_a_gate_of_one_of_them) {
  std::string text = kRow;
  text.replace(text.find("\"ode\""), 5, "\"ode\", \"ode:quickstep\"");
  Case definition = drifting_body("drift");
  Gate gate;
  gate.metric = "position_error", gate.engines = {"ode:quickstep"};
  definition.gates = {gate};
  check_known_deviations(read(text), {definition}, infos());
}

// The recorded value includes the deviation.
BOOST_AUTO_TEST_CASE(a_regression_is_no_deviation_that_is_known) {
  Results grid = judged(2, 0.5, {});
  CaseResult& result = grid.cases.front();
  test::limit_as<RegressionLimit>(result.definition.gates.front()).factor = 1.25;
  for (const GateResult& answer : result.gates) BOOST_TEST_REQUIRE(answer.gate == 0u);
  const auto before = result.gates;
  apply_known_deviations(result, grid, read(kRow));
  for (std::size_t i = 0; i < before.size(); ++i) BOOST_TEST((result.gates[i].answer == before[i].answer));
  BOOST_TEST(!all_gates_hold(grid));
}

// The shipped ones name cases of the suite, and are met by its gates.
BOOST_AUTO_TEST_CASE(the_shipped_rows_speak_of_gates_that_there_are) {
  const auto rows = read_known_deviations(default_adapters_dir(), infos());
  const auto cases = select_cases({}, default_suite_dir(), test::words());
  for (const KnownDeviation& row : rows) {
    BOOST_TEST(std::any_of(cases.begin(), cases.end(), [&](const Case& c) { return c.id == row.case_id; }), row.where);
  }
  check_known_deviations(rows, cases, infos());
}

BOOST_AUTO_TEST_SUITE_END()
