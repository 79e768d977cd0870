// The results of several folders as one: what is current, and the history of each run.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cases/report/site/written_folder.h"
#include "cases/results/cell_key.h"

namespace rigor::inline report {

struct MergedResults {
  Json results = nullptr;           // a results.json of all current cells; engines[].made_by is the version of Rigor
  Json shown = nullptr;             // the same as the page of a case shows it, with more details and fewer digits
  Json series = Json::array();      // the names that a motion's series stand for
  std::map<CellKey, Json> motions;  // packed, see report/html/playback.h
  std::map<std::string, Json> truth_motions;  // by case
  std::vector<HistoryEntry> history;          // the oldest first
};

// The folders are given from the oldest to the newest. Of a run, only its newest version is current, where the version
// is that of the engine and of Rigor. Cells of a case that has changed since are left out, and `notes` says so. Throws
// InputError if two folders hold a cell of one version with different values: such a run does not repeat.
MergedResults merged_results(std::vector<WrittenFolder> folders, std::vector<std::string>& notes);

}  // namespace rigor::inline report
