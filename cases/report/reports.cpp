#include "cases/report/reports.h"

namespace rigor {

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

}  // namespace rigor
