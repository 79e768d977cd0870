// The first thing to look at: cases by engines at one step size, a verdict in a word and the error that matters.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/cell_error.h"
#include "cases/report/wording/comparison.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// At headline_dt(); a case that has no such step is shown at its coarsest, which its row says.
// With `Words::few` what is stable or unsupported is told by its sign alone, for where many cases stand.
enum class Words { all, few };
TextTable verdict_matrix(const Results& results, Words words = Words::all);
// Of these runs alone, one a column.
TextTable verdict_matrix(const Results& results, Words words, const std::vector<std::size_t>& runs);

// Up to so many columns are read at a glance; of more runs, the first of each engine, grouped as they come.
inline constexpr std::size_t kMostMatrixColumns = 7;
std::vector<std::size_t> readable_columns(const Results& results, const std::vector<std::size_t>& runs);

// One character for how a cell ended: of one that passed, its verdict's.
std::string sign_of(const Cell& cell);

// m: what a case's position errors are large or small against. The longest of the line across the bodies that can move,
// at the start, the longest spring, and the diameter of the largest such body (without a shape: of gyration).
double size_of(const Scene& scene);

// How dark a cell is: its main error in decades of the case's size, or of 1 rad, which moves points by the body's own
// radius. " " below 1e-3 or where there is none to show, "░" from there, "▒" from 1e-2, "▓" from 1e-1, "█" from 1 on.
std::string shade_of(const CaseResult& result, const Cell& cell);

}  // namespace rigor::inline report
