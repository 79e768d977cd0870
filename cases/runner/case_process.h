// What happens inside the process of one case: the truth is made, then each cell is run and judged in a child of its
// own, which inherits the truth. Results go to the grid's process as messages (cases/results/result_json.h).
#pragma once

#include "cases/runner/grid.h"
#include "cases/runner/process_pool.h"
#include "cases/runner/truth_samples.h"

namespace rigor {

void run_case(const Results& grid, const CaseResult& planned, const EngineTable& engines, const GridOptions& options,
              const Channel& channel);

// Simulates, judges and records one cell: everything but its gates. `truth` may be null. The path is what the cell's
// spread from others is found by.
struct JudgedCell {
  Cell cell;
  Path path;
};
JudgedCell run_cell(const Cell& planned, const Case& definition, const EngineTable& engines, const RunName& run_name,
                    const Truth* truth, const TruthFacts& facts, const GridOptions& options,
                    const TruthOnSteps& truth_on_steps = {});

}  // namespace rigor
