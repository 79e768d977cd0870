// Results of a run that was never made, with every kind of ending in it.
#pragma once

#include <limits>

#include "cases/results/results.h"
#include "tests/cases/runner/faulty_engine.h"

namespace rigor {

inline MetricValue sample_metric(double value, const Instant& worst) {
  MetricValue metric;
  metric.value = value, metric.first_second = value / 2, metric.worst = worst, metric.compared_until = 0.5;
  return metric;
}

inline Results sample_results() {
  Results grid;
  EngineTable table;
  for (const char* name : {"good", "wild"}) table.add(std::make_unique<FaultyEngine>(name, [](double&) {}));
  grid.engines = infos_of(table);
  for (const char* name : {"good", "wild"}) grid.runs.push_back(parse_run_name(name, grid.engines));
  CaseResult result;
  result.definition = drifting_body("family/case");
  result.definition.title = "A <b>bold</b> | title";
  result.definition.scene.bodies.front().name = "st|one \"1\", <i>";
  result.truth = TruthFacts{1e-9, 0.5, 50};
  for (std::size_t run = 0; run < 2; ++run) {
    for (const StepSize& dt : result.definition.dt) {
      Cell cell;
      cell.run = run, cell.dt = dt;
      cell.metrics["position_error"] = sample_metric(0.25, {0.3, 0, "position.y", 2, 1.75});
      cell.metrics["energy_drift"] = sample_metric(0.5, {0.3, kWorld, "energy", 10, 15});
      cell.metrics["orientation_error"].not_applicable = "nothing turns";
      cell.scheme.twin = "core:its-twin";
      cell.scheme.metrics["position_error"] = sample_metric(0.24, {0.3, 0, "position.y", 2, 1.76});
      cell.metrics["unexplained_error"] = sample_metric(0.01, {0.4, 0, "position.y", 2, 2.01});
      cell.settings = {{"solver", "exact"}};
      cell.status = Status::pass, cell.reason = "";
      cell.trajectory = "t" + std::to_string(result.cells.size()) + ".csv";
      result.cells.push_back(cell);
    }
    result.stable_steps.push_back({Status::pass, "", {0.0678, false, false}});
  }
  Cell& blown_up = result.cells[2];
  blown_up.status = Status::diverged, blown_up.reason = "blown up at 0.40 s";
  blown_up.stability = {Verdict::blown_up, 0.4, 0, "its numbers are not finite"};
  blown_up.metrics["position_error"].value = std::numeric_limits<double>::infinity();
  Cell& crashed = result.cells[3];
  crashed = Cell();
  crashed.run = 1, crashed.dt = result.definition.dt[1], crashed.reason = "killed by SIGSEGV; its last words: \xff\xfe";
  result.stable_steps[1] = {Status::timed_out, "no result", {}};
  grid.cases.push_back(result);
  return grid;
}

}  // namespace rigor
