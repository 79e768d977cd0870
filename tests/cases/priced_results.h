// Results whose cells have errors and costs that a test states, for what is read across cells.
#pragma once

#include "cases/results/results.h"
#include "tests/cases/runner/faulty_engine.h"

namespace rigor::test {

struct Priced {
  double dt, error, cost;  // s; m; s/s
};

// One case, a run for each name; "core" takes part as an engine of that name.
inline Results priced_results(const std::vector<std::pair<std::string, std::vector<Priced>>>& runs,
                              const std::string& metric = "position_error") {
  Results grid;
  EngineTable table;
  for (const auto& [name, cells] : runs) table.add(std::make_unique<FaultyEngine>(name, [](double&) {}));
  grid.engines = infos_of(table);
  CaseResult result;
  result.definition = drifting_body("family/case");
  result.definition.dt.clear();
  result.truth = TruthFacts{1e-12, 0.5, 50};
  for (const auto& [name, cells] : runs) {
    grid.runs.push_back(parse_run_name(name, grid.engines));
    result.stable_steps.push_back({Status::pass, "", {0.5, false, false}});
    for (const Priced& priced : cells) {
      Cell cell;
      cell.run = grid.runs.size() - 1;
      cell.dt = {priced.dt, std::to_string(priced.dt)};
      cell.status = Status::pass, cell.reason = "";
      cell.metrics[metric].value = priced.error, cell.metrics["cost"].value = priced.cost;
      result.cells.push_back(cell);
      if (grid.runs.size() == 1) result.definition.dt.push_back(cell.dt);
    }
  }
  grid.cases.push_back(result);
  return grid;
}

}  // namespace rigor::test
