// The process of one case: it makes the truth, then runs and judges each cell in a child process, which inherits the
// truth. Results go to the grid's process as messages (cases/results/result_json.h).
#pragma once

#include "cases/runner/grid.h"
#include "cases/runner/journal/case_journal.h"
#include "cases/runner/process_pool.h"
#include "cases/runner/truth_samples.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline runner {

class EnsembleReference;  // ensemble.h

void run_case(const Results& grid, const CaseResult& planned, const EngineTable& engines, const GridOptions& options,
              const Channel& channel);

// Simulates, judges and records one cell, without its gates. `truth` and `reference` may be null. The path serves to
// find the cell's spread.
struct JudgedCell {
  Cell cell;
  Path path;
};
JudgedCell run_cell(const Cell& planned, const Case& definition, const EngineTable& engines, const RunName& run_name,
                    const Truth* truth, const TruthFacts& facts, const GridOptions& options,
                    const TruthOnSteps& truth_on_steps = {}, const EnsembleReference* reference = nullptr);

// How a cell ended whose engine failed in this way.
Status status_of(FailureKind kind);

// `truth` may be null.
TruthFacts facts_of(const Case& definition, const Truth* truth);

// For every pair of runs at the same dt that both left a path. It also compares each run with itself at its finest step
// where no truth is known.
std::vector<Spread> spreads_of(const CaseResult& planned, const PathsOfCells& paths);

}  // namespace rigor::inline runner
