// A grid of runs to hold gates against, and its answers.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "cases/gates/gates.h"
#include "tests/cases/runner/faulty_engine.h"

namespace rigor::test {

// Two engines at two steps; position_error is c dt^order with c = 1 for "a", 10 for "b".
struct GatedGrid {
  Results grid;

  explicit GatedGrid(double order = 2) {
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

inline Gate gate(const std::string& metric) {
  Gate out;
  out.metric = metric, out.because = "a reason", out.where = "case.toml:7:1";
  return out;
}

inline int count(const std::vector<GateResult>& results, GateAnswer answer) {
  return static_cast<int>(
      std::count_if(results.begin(), results.end(), [&](const auto& r) { return r.answer == answer; }));
}

}  // namespace rigor::test
