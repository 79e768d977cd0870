// A folder that `rigor run` or `rigor gate` wrote, as the site reads it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cases/results/cell_key.h"
#include "cases/results/history.h"
#include "core/base/json.h"

namespace rigor::inline report {

struct WrittenFolder {
  std::string path;                 // as given
  std::string made_by;              // the version of Rigor
  Json results;                     // results.json
  Json shown = nullptr;             // the results as the folder's report.html holds them; null without that report
  Json series = Json::array();      // of the report: the names that a motion's series stand for
  std::map<CellKey, Json> motions;  // of the report, packed: see report/html/playback.h
  std::map<std::string, Json> truth_motions;  // likewise, by case
  HistoryEntry entry;                         // of its cells; the commit is the version of Rigor
};

// Throws InputError for a folder without a results.json of the present schema. A report of other results is left out,
// and `notes` says so.
WrittenFolder read_written_folder(const std::string& path, std::vector<std::string>& notes);

}  // namespace rigor::inline report
