// The error and the cost of a cell from entry to entry of a history, and the entries where their level changes.
#pragma once

#include <string>
#include <vector>

#include "cases/results/history.h"

namespace rigor::inline analysis {

struct CellSeries {
  std::vector<double> values;        // one per entry of the history; NaN if the entry has none
  std::vector<std::size_t> changes;  // the first entry of each new level
};

struct CellHistory {
  std::string name, metric;  // case, engine and dt; the metric that is followed
  CellSeries error, cost;    // any change of an error counts; a change of cost must exceed its noise
                             // (change_point.h). Costs of machines other than the last entry's are left out.
  std::string status_change;
  bool has_changed() const { return !error.changes.empty() || !cost.changes.empty() || !status_change.empty(); }
};

// The cells whose names contain one of `words`, sorted by name; all cells if there are no words.
std::vector<CellHistory> cell_histories(const std::vector<HistoryEntry>& history,
                                        const std::vector<std::string>& words);

// The median levels before and after a change.
struct LevelChange {
  double before, after;
  std::size_t entry;
};
LevelChange level_change(const CellSeries& series, std::size_t which);

// Ignores NaN; NaN if nothing is left.
double median_of(std::vector<double> values);

}  // namespace rigor::inline analysis
