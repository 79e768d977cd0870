// How much of an engine's error is its scheme's, and how much nobody can explain: a row for each run that has a twin.
#pragma once

#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor::inline report {

// total: the engine against the truth. by_scheme: its twin against the truth. unexplained: the engine against its twin,
// up to the instant `until`. All in words, rounded to what can be read.
struct ExplainedRow {
  std::string engine;
  std::string total, by_scheme, unexplained;                       // m
  std::string rotation, rotation_by_scheme, rotation_unexplained;  // rad
  std::string until;                                               // s
};

// Of the cells at this step size; none where no run has a twin.
std::vector<ExplainedRow> explained_rows(const Results& results, const CaseResult& result, const StepSize& dt);

}  // namespace rigor::inline report
