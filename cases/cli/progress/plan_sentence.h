// What a run is about to do, and how long that takes.
#pragma once

#include <string>

#include "cases/cli/grid_run.h"
#include "cases/cli/progress/time_left.h"
#include "cases/results/results.h"

namespace rigor::inline cli {

// "3 cases by 20 runs: 140 cells, 12 more unsupported; 20 to 60 s with 2 jobs; the reports will be in out".
std::string plan_sentence(const Results& planned, const GridRequest& asked);

// Cells that the results.json in its folder has from this machine count with the time that they took there. All others
// count with what a step of a body costs in the mean, which is right to a factor of four either way.
Estimate estimated_seconds(const Results& planned, const GridRequest& asked);

}  // namespace rigor::inline cli
