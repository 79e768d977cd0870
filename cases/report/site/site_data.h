// All that the pages, the badges and the JSON of the site are made from.
#pragma once

#include <string>
#include <vector>

#include "cases/report/site/merged_results.h"
#include "cases/report/site/score.h"

namespace rigor::inline report {

struct SiteData {
  MergedResults merged;
  Results results;  // those of merged.results, as the analyses read them
  StepSize headline;
  std::vector<EngineRuns> engines;
  std::vector<std::string> families;
  std::vector<HistoryEntry> history;  // the oldest first
};

}  // namespace rigor::inline report
