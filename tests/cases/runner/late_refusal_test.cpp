// An engine that could make gates skip its bad runs by refusing the scene after it knows the result.
#include <boost/test/unit_test.hpp>

#include "cases/gates/gates.h"
#include "cases/runner/grid.h"
#include "core/engine/engine_failure.h"
#include "tests/cases/limit_as.h"
#include "tests/cases/runner/faulty_engine.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_late_refusal)

namespace {

// One case, whose only gate the engine cannot hold, beside an engine that holds it.
Results run_with(const FaultyEngine::Fault& fault) {
  EngineTable table;
  table.add(std::make_unique<FaultyEngine>("good", [](double&) {}));
  table.add(std::make_unique<FaultyEngine>("shy", fault));
  Case definition = drifting_body("a");
  Gate gate;
  gate.metric = "survival", test::limit_as<BoundLimit>(gate).min = 0.5;
  definition.gates = {gate};
  const auto infos = infos_of(table);
  Results grid = plan_grid({definition}, {parse_run_name("good", infos), parse_run_name("shy", infos)}, table, {false});
  run_grid(grid, table, {}, [](std::size_t, std::size_t) {});
  check_gates(grid.cases[0], grid, {});
  return grid;
}

void refuse() { throw EngineFailure(FailureKind::unsupported, "it says that it cannot"); }

}  // namespace

BOOST_AUTO_TEST_CASE(an_engine_may_refuse_a_step_before_it_has_taken_one) {
  const Results grid = run_with([](double&) { refuse(); });
  for (const Cell& cell : grid.cases[0].cells) {
    if (cell.run == 1) BOOST_TEST((cell.status == Status::unsupported), cell.reason);
  }
  BOOST_TEST(all_gates_hold(grid));
}

BOOST_AUTO_TEST_CASE(one_that_refuses_after_steps_that_it_took_has_no_result_and_the_gate_fails) {
  const Results grid = run_with([](double& x) {
    if (x > 2.5) refuse();
    x += 1;
  });
  for (const Cell& cell : grid.cases[0].cells) {
    if (cell.run == 0) continue;
    BOOST_TEST((cell.status == Status::invalid));
    BOOST_TEST(cell.reason.find("after 3 steps it says that it cannot") != std::string::npos, cell.reason);
  }
  BOOST_TEST(!all_gates_hold(grid));
}

BOOST_AUTO_TEST_SUITE_END()
