#include "cases/report/reports.h"

#include "cases/report/csv/series_csv.h"
#include "cases/report/csv/trajectory_csv.h"
#include "cases/report/html/playback.h"

namespace rigor::inline report {

// One row a writer, alphabetical.
const std::vector<ReportRow>& reports() {
  static const std::vector<ReportRow> table = {
#if RIGOR_HTML_REPORT
    {"html", "report.html", html_report},
#endif
    {"json", "results.json", json_report},
    {"junit", "junit.xml", junit_report},
    {"markdown", "report.md", markdown_report},
  };
  return table;
}

Recorders recorders_for(const Results& grid, const std::string& folder, bool has_series) {
  Recorders recorders = {std::make_shared<TrajectoryRecorder>(folder)};
#if RIGOR_HTML_REPORT
  recorders.push_back(std::make_shared<PlaybackRecorder>(grid));
#endif
  if (has_series) recorders.push_back(std::make_shared<SeriesRecorder>(folder));
  return recorders;
}

}  // namespace rigor::inline report
