// What a continued run reuses. A cell that failed in an engine from outside is tried again, because the cause may have
// been fixed outside Rigor. Finished cells are not repeated.
#include <boost/test/unit_test.hpp>

#include "cases/case/run_selector.h"
#include "cases/runner/grid.h"
#include "core/engine/engine_failure.h"
#include "tests/cases/runner/faulty_engine.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_resume)

namespace {

// One from outside that dies while `is_broken`, and one that never does.
EngineTable table_of(bool is_broken) {
  const auto step = [is_broken](double&) {
    if (is_broken) throw EngineFailure(FailureKind::crashed, "it died");
  };
  EngineTable table;
  table.add(std::make_unique<FaultyEngine>("good", [](double&) {}));
  table.add(std::make_unique<FaultyEngine>("outside", step), "some file, and its hash");
  return table;
}

std::map<std::string, Status> ends_of(const EngineTable& table, const std::string& journals) {
  Results grid = plan_grid({drifting_body("a")}, default_runs(infos_of(table)), table, {false});
  GridOptions options{1, 5, {}, false, false};
  options.journals = journals;
  run_grid(grid, table, options, [](std::size_t, std::size_t) {});
  std::map<std::string, Status> ends;
  for (const Cell& cell : grid.cases.front().cells) ends[grid.runs[cell.run].engine] = cell.status;
  return ends;
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_died_outside_is_tried_again) {
  const Folder folder;
  const std::string journals = folder.path.string();
  auto ends = ends_of(table_of(true), journals);
  BOOST_TEST((ends["outside"] == Status::crashed && ends["good"] == Status::pass));
  ends = ends_of(table_of(false), journals);
  BOOST_TEST((ends["outside"] == Status::pass));
  // And what it came to then is kept in its turn.
  ends = ends_of(table_of(true), journals);
  BOOST_TEST((ends["outside"] == Status::pass));
}

BOOST_AUTO_TEST_SUITE_END()
