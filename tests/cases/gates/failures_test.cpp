#include "cases/gates/failures.h"

#include <boost/test/unit_test.hpp>

#include "tests/cases/gates/gated_grid.h"
#include "tests/cases/limit_as.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_gates_failures)

namespace {

// The row of a gate that fails on the first cell of "a", of 0.01 m.
Failure failure_of(const Gate& asked, GateAnswer answer = GateAnswer::failed, bool has_value = true) {
  GatedGrid fixture;
  fixture.result().definition.gates = {asked};
  GateResult result{0, "a", "1/10", answer, "the answer's text"};
  if (has_value) result.value = 0.01, result.worst = Instant{0.25, 0, "position.x", 1.5, 1.25};
  fixture.result().gates = {result};
  const auto rows = failures(fixture.grid);
  BOOST_TEST_REQUIRE(rows.size() == 1u);
  return rows.front();
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_kind_of_gate_says_its_limit) {
  struct Row {
    const char* limit;
    void (*set)(Gate&);
  };
  for (const Row& row :
       {Row{"at most 0.5 m", [](Gate& gate) { test::limit_as<BoundLimit>(gate).max = 0.5; }},
        Row{"at least 0.25 m", [](Gate& gate) { test::limit_as<BoundLimit>(gate).min = 0.25; }},
        Row{"at least 0.25 m, at most 0.5 m",
            [](Gate& gate) {
              test::limit_as<BoundLimit>(gate).min = 0.25, test::limit_as<BoundLimit>(gate).max = 0.5;
            }},
        Row{"equal to 0.5 m", [](Gate& gate) { test::limit_as<BoundLimit>(gate).equals = 0.5; }},
        Row{"order at least 1.9", [](Gate& gate) { test::limit_as<OrderLimit>(gate).at_least = 1.9; }},
        Row{"the order that its method declares, less a tenth",
            [](Gate& gate) {
              test::limit_as<OrderLimit>(gate).at_least = 0.1, test::limit_as<OrderLimit>(gate).is_declared = true;
            }},
        Row{"within 1.25 times the recorded value",
            [](Gate& gate) { test::limit_as<RegressionLimit>(gate).factor = 1.25; }},
        Row{"better than b", [](Gate& gate) { test::limit_as<RankingLimit>(gate).better_than = "b"; }}}) {
    Gate asked = gate("position_error");
    row.set(asked);
    BOOST_TEST(failure_of(asked).limit == row.limit);
  }
}

BOOST_AUTO_TEST_CASE(a_row_says_what_was_found_where_and_why) {
  Gate limit = gate("position_error"), regression = limit, order = limit;
  test::limit_as<BoundLimit>(limit).max = 0.005, test::limit_as<RegressionLimit>(regression).factor = 1.25,
  test::limit_as<OrderLimit>(order).at_least = 1;
  const Failure row = failure_of(limit);
  BOOST_TEST(row.case_id == "case");
  BOOST_TEST((row.engine == "a" && row.dt == "1/10" && row.where == "case.toml:7:1"));
  BOOST_TEST(row.what == "position_error");
  BOOST_TEST(row.found == "0.01 m");
  BOOST_TEST(row.worst == "at 0.25 s: stone, position.x: found 1.5, expected 1.25");
  BOOST_TEST(row.because == "a reason");
  BOOST_TEST(failure_of(regression).what == "position_error (regression)");
  BOOST_TEST(failure_of(order).found == "0.01");  // an order has no unit
}

// If there is no value, or an unexpected pass, the answer itself gives the reason.
BOOST_AUTO_TEST_CASE(a_row_without_a_value_or_of_an_unexpected_pass_says_the_answer) {
  Gate limit = gate("position_error");
  test::limit_as<BoundLimit>(limit).max = 0.005;
  const Failure none = failure_of(limit, GateAnswer::not_checked, false);
  BOOST_TEST((none.found == "not checked" && none.worst.empty() && none.because == "the answer's text"));
  BOOST_TEST(failure_of(limit, GateAnswer::failed, false).because == "the answer's text");
  const Failure unexpected = failure_of(limit, GateAnswer::unexpected_pass);
  BOOST_TEST((unexpected.what == "position_error, unexpected pass" && unexpected.because == "the answer's text"));
}

BOOST_AUTO_TEST_CASE(cells_that_came_to_nothing_are_rows_and_what_held_or_cannot_be_is_none) {
  for (const Status status : {Status::pass, Status::fail, Status::unsupported, Status::diverged, Status::crashed,
                              Status::timed_out, Status::invalid}) {
    GatedGrid fixture;
    fixture.cell(1).status = status, fixture.cell(1).reason = "it is so";
    const auto rows = failures(fixture.grid);
    const bool is_row = status == Status::crashed || status == Status::timed_out;
    BOOST_TEST_REQUIRE(rows.size() == (is_row ? 1u : 0u), word_of(status));
    if (!is_row) continue;
    BOOST_TEST((rows[0].engine == "a" && rows[0].dt == "1/20" && rows[0].what == word_of(status)));
    BOOST_TEST(rows[0].because == "it is so");
  }
}

// A cell that is invalid where a gate of the same run and step fails; not for another's failure.
BOOST_AUTO_TEST_CASE(an_invalid_cell_is_a_row_where_its_own_gate_fails) {
  struct Row {
    const char *engine, *dt;
    GateAnswer answer;
    std::size_t rows;
  };
  for (const Row& row : {Row{"a", "1/20", GateAnswer::failed, 2}, Row{"b", "1/20", GateAnswer::failed, 1},
                         Row{"a", "1/10", GateAnswer::failed, 1}, Row{"a", "1/20", GateAnswer::held, 0}}) {
    GatedGrid fixture;
    Gate limit = gate("position_error");
    test::limit_as<BoundLimit>(limit).max = 1;
    fixture.result().definition.gates = {limit};
    fixture.cell(1).status = Status::invalid;
    fixture.result().gates = {{0, row.engine, row.dt, row.answer, "text"}};
    BOOST_TEST(failures(fixture.grid).size() == row.rows, row.engine << " " << row.dt);
  }
}

BOOST_AUTO_TEST_CASE(a_case_that_cannot_be_judged_is_one_row_and_its_cells_are_none) {
  GatedGrid fixture;
  fixture.result().error = "there is no truth", fixture.result().definition.truth_where = "case.toml:3:1";
  fixture.cell(0).status = Status::crashed;
  const auto rows = failures(fixture.grid);
  BOOST_TEST_REQUIRE(rows.size() == 1u);
  BOOST_TEST((rows[0].what == "truth" && rows[0].because == "there is no truth" && rows[0].where == "case.toml:3:1"));
  BOOST_TEST((rows[0].engine.empty() && rows[0].dt.empty()));
}

BOOST_AUTO_TEST_SUITE_END()
