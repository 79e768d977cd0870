// The output of `rigor run`, in at most 100 columns of plain text: which engine and step to take, the problems found,
// then one block per case with one row per engine. For many cases a matrix of cases and engines stands in place of the
// blocks.
#pragma once

#include <string>
#include <vector>

#include "cases/gates/failures.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// brief: one case fits on a screen. full: with the truth's provenance, explained errors, every reason and every
// finding.
enum class Detail { brief, full };
std::string console_table(const Results& results, Detail detail = Detail::full);

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

}  // namespace rigor::inline report
