// The journal of one case, or of a shard's part of it: its place, the plan that it belongs to, and which of its entries
// are trusted.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cases/runner/grid.h"
#include "cases/runner/journal/journal.h"

namespace rigor::inline runner {

// Its file; empty where none is kept. `share`: of the case; 0: all of it.
std::string journal_of(const CaseResult& planned, const Results& grid, int share, const GridOptions& options);

// All that the case's results depend on: another program, too, makes other results.
std::string plan_of(const Results& grid, const CaseResult& planned, const EngineTable& engines,
                    const GridOptions& options);

// The results of cells and stable steps in the journals of a case that has run; failed ones left nothing. `grid` is as
// planned.
std::vector<Journal::Record> kept_answers(const Results& grid, const CaseResult& planned, const EngineTable& engines,
                                          const GridOptions& options);

using PathsOfCells = std::map<std::size_t, Path>;  // by index of the cell
PathsOfCells paths_in(const CaseResult& planned, const std::vector<Journal::Record>& answers);

// Not believed: what cannot be read, a cell whose trajectory is no longer there, and one that may end otherwise.
void forget_what_is_wrong(Journal& journal, const Results& grid, const CaseResult& planned, const EngineTable& engines,
                          const GridOptions& options);

}  // namespace rigor::inline runner
