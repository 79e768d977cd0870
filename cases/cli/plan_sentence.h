// What a run is about to do, and about how long that takes.
#pragma once

#include <string>

#include "cases/cli/command_line.h"
#include "cases/results/results.h"

namespace rigor {

// "3 cases by 20 runs at up to 3 steps: 140 cells, 12 more unsupported; about 40 s on 2 cores".
std::string plan_sentence(const Results& planned, const CommandLine& line);

// s of wall time, from what steps of a body cost here in the mean: right to a factor of three.
double estimated_seconds(const Results& planned, const CommandLine& line);

}  // namespace rigor
