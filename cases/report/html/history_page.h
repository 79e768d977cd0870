// history.html: how errors and costs moved from commit to commit, drawn. One file that needs nothing else, no script
// either.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/cell_history.h"
#include "cases/results/history.h"

namespace rigor::inline report {

// For all cells, or those whose names contain one of `words`: changed ones first.
std::string history_page(const std::vector<HistoryEntry>& history, const std::vector<std::string>& words);

// One cell: its name, the change of its status, and its error and cost drawn, as HTML.
std::string history_section(const CellHistory& cell, const std::vector<HistoryEntry>& history);

}  // namespace rigor::inline report
