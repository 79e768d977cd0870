// The main findings over all cases: how near a recording is met, blow-ups, stiff springs, the step that a millimetre
// takes, energy, friction, impacts, joints, and errors that no scheme explains.
#pragma once

#include <string>
#include <vector>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// `text` is read at a glance. Findings of one topic stand together.
using Finding = Message;
std::vector<Finding> findings(const Results& results);

// The step size that the first page shows: 1/30 s if any case has it, else the coarsest of all.
StepSize headline_dt(const Results& results);

}  // namespace rigor::inline report
