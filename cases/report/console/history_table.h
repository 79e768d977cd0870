// How each cell's error and cost moved along a history, a line a cell.
#pragma once

#include <string>
#include <vector>

#include "cases/results/history.h"

namespace rigor::inline report {

// Cells whose names hold one of `words`; without any, those that have changed, and all where they are few.
std::string history_table(const std::vector<HistoryEntry>& history, const std::vector<std::string>& words);

// Eight heights, in logarithms where all values are above 0: "▁▁▃█". A value that is not a number is a blank, one that
// is not finite a cross.
std::string sparkline(const std::vector<double>& values);

}  // namespace rigor::inline report
