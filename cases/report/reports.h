// The table of report writers: each turns the results into the text of one file.
#pragma once

#include <string>
#include <vector>

#include "cases/runner/recorder.h"

namespace rigor::inline report {

struct ReportRow {
  std::string name;
  std::string file_name;
  std::string (*write)(const Results& results);
};

const std::vector<ReportRow>& reports();  // alphabetical

// The recorders that the reports of a planned grid need; trajectories go to `folder`, and series of metrics if asked.
Recorders recorders_for(const Results& grid, const std::string& folder, bool has_series = false);

std::string html_report(const Results& results);  // only in a build with RIGOR_HTML_REPORT
std::string json_report(const Results& results);
std::string junit_report(const Results& results);
std::string markdown_report(const Results& results);

}  // namespace rigor::inline report
