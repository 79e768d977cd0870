// How a cell moved along a history: its error and its cost, and where they changed their level.
#pragma once

#include <string>
#include <vector>

#include "cases/results/history.h"

namespace rigor {

struct CellSeries {
  std::vector<double> values;        // of each entry of the history; not a number where it has none
  std::vector<std::size_t> changes;  // entries with which a new level begins
};

struct CellHistory {
  std::string name, metric;  // case, engine and dt; the metric that says most of those it has
  CellSeries error, cost;    // an error repeats bit for bit, so any change counts; a cost's has to be beyond its noise
  std::string status_change;
  bool has_changed() const { return !error.changes.empty() || !cost.changes.empty() || !status_change.empty(); }
};

// Of all cells whose names have one of `words` in them, or of all; by name.
std::vector<CellHistory> cell_histories(const std::vector<HistoryEntry>& history,
                                        const std::vector<std::string>& words);

// The levels, as medians, before and after a change.
struct LevelChange {
  double before, after;
  std::size_t entry;
};
LevelChange level_change(const CellSeries& series, std::size_t which);

// Of values that are numbers; not a number of none.
double median_of(std::vector<double> values);

}  // namespace rigor
