// The main error of a cell, and which cells and runs count where errors are compared.
#pragma once

#include <string>

#include "cases/results/main_error.h"
#include "cases/results/results.h"

namespace rigor::inline analysis {

// Whether the main error is an error against a truth, in m or rad.
bool has_main_error_of_truth(const CaseResult& result);

// The headline's step if the case has it, else its coarsest.
StepSize matrix_dt(const CaseResult& result, const StepSize& headline);

// The main error of one cell, as far as the truth is a witness of the run.
struct MainErrorOfCell {
  enum class Kind { none, failed, value } kind = Kind::none;  // none: unsupported, or without that error
  double value = 0;                                           // m, rad or a share of energy; infinite if failed
};
MainErrorOfCell main_error_of(const CaseResult& result, const Cell& cell, const std::string& metric);

// A motion that is wrong as a whole (blown up, collapsed, ...), though its numbers are finite.
bool is_wrong_as_a_whole(const Cell& cell);

// Whether a run is an adaptive method of ours. Such a method divides its steps until a tolerance holds: it is a
// reference and no choice of step, so reports show it apart.
bool is_reference_method(const Results& results, std::size_t run);

}  // namespace rigor::inline analysis
