// What the whole of the results comes to, in a few sentences: who blows up, who loses energy and why, what is left that
// no scheme explains, what a millimetre costs.
#pragma once

#include <string>
#include <vector>

#include "cases/runner/results.h"

namespace rigor {

std::vector<std::string> findings(const Results& results);

// The step size that the first page shows: 1/30 s if any case has it, else the coarsest of all.
StepSize headline_dt(const Results& results);

}  // namespace rigor
