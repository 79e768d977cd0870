// The first thing to look at: cases by engines at one step size, a verdict in a word and the error that matters.
#pragma once

#include <string>

#include "cases/report/wording/comparison.h"
#include "cases/results/results.h"

namespace rigor {

// The error that a case is about: its runs' largest position error; where nothing moves away, the orientation's;
// without a truth, the energy's drift.
std::string main_error(const CaseResult& result);

// At headline_dt(); a case that has no such step is shown at its coarsest, which its row says.
TextTable verdict_matrix(const Results& results);

// The step whose cells stand in a case's row: the headline's if the case has it, else its coarsest.
StepSize matrix_dt(const CaseResult& result, const StepSize& headline);

// One character for how a cell ended.
std::string sign_of(const Cell& cell);

}  // namespace rigor
