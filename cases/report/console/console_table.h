// The output of `rigor run`: one block per case with one row per engine, in at most 100 columns of plain text. For many
// cases it is the matrix of cases and engines.
#pragma once

#include <string>
#include <vector>

#include "cases/gates/failures.h"
#include "cases/results/results.h"

namespace rigor {

std::string console_table(const Results& results);

// The failures, one paragraph each, worst first.
std::string failures_text(const std::vector<Failure>& rows, const std::string& diagnose);

// How many gates held, failed and were not checked.
std::string gate_summary(const Results& results);

// The parts of a row in words, rounded for reading; report.md shows the same.
struct RowText {
  std::string engine;
  std::string first_second, whole, orientation, energy, energy_synchronised, stable_dt, verdict;
  bool has_numbers = true;  // if not, `verdict` is a sentence that stands in their place
  bool is_blown_up = false;
};
RowText row_text(const Results& results, const CaseResult& result, const Cell& cell);
std::string truth_sentence(const CaseResult& result);
// A sentence for each run that was stepped in part by less than its method.
std::vector<std::string> cell_warnings(const Results& results, const CaseResult& result, const StepSize& dt);

}  // namespace rigor
