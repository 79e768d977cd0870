// How the errors of one engine moved from version to version.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/cell_history.h"
#include "cases/report/site/site_data.h"

namespace rigor::inline report {

// A step of a cell's error: the first entry of a new level.
struct ErrorStep {
  std::string cell, metric;  // the cell: case, run and dt
  double before = 0, after = 0;
  std::string at;  // the version
  bool is_worse = false;
};

struct EngineHistory {
  std::vector<HistoryEntry> entries;  // those that have the engine; the commit is "VERSION (COMMIT)"
  std::vector<CellHistory> changed;   // cells whose error or status changed, the largest step to the worse first
  std::vector<ErrorStep> steps;       // likewise; a cell may have several
};

EngineHistory history_of_engine(const SiteData& data, const EngineRuns& engine);

}  // namespace rigor::inline report
