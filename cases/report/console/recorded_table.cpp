#include "cases/report/console/recorded_table.h"

#include <algorithm>

#include "cases/report/layout.h"
#include "cases/report/wording/recorded_error.h"

namespace rigor::inline report {

std::string recorded_table(const Results& results, const CaseResult& result) {
  const TextTable table = recorded_errors(results, result);
  if (table.rows.empty()) return "";
  std::vector<std::size_t> widths(table.rows[0].size());
  for (const auto& row : table.rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  std::string text = "  " + wrapped(table.heading, 2) + "\n";
  for (const auto& row : table.rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string blanks(widths[i] - width_of(row[i]), ' ');
      line += " " + (i == 0 ? row[i] + blanks : blanks + row[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace rigor::inline report
