// Results with a gate, and what `compare` keeps of them.
#pragma once

#include <string>

#include "cases/gates/gates.h"
#include "cases/report/reports.h"
#include "cases/results/baseline.h"
#include "tests/cases/limit_as.h"
#include "tests/cases/report/sample_results.h"
#include "tests/folder.h"

namespace rigor {

inline Results gated_results(double limit = 1) {
  Results grid = sample_results();
  Gate gate;
  gate.metric = "position_error", test::limit_as<BoundLimit>(gate).max = limit, gate.engines = {"good"},
  gate.because = "a reason";
  grid.cases.front().definition.gates = {gate};
  check_gates(grid.cases.front(), grid);
  return grid;
}

inline Baseline outcomes_of(const Results& grid) {
  const Folder folder;
  return read_baseline(folder.write("results.json", json_report(grid)));
}

}  // namespace rigor
