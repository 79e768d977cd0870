#include "cases/report/github/job_summary.h"

#include <fmt/format.h>

#include <map>

#include "cases/report/console/console_table.h"
#include "cases/report/markdown/markdown_text.h"

namespace rigor::inline report {
namespace {

// A workflow command ends with its line; in a property colon and comma end it too.
std::string percent_encoded(const std::string& text, bool is_property) {
  std::string out;
  for (const char c : text) {
    const bool is_special = c == '%' || c == '\r' || c == '\n' || (is_property && (c == ':' || c == ','));
    out += is_special ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return out;
}

// "a/b.toml:7:1" as ",file=a/b.toml,line=7,col=1".
std::string place_of(const std::string& where) {
  const std::size_t column = where.rfind(':'), line = column == 0 ? column : where.rfind(':', column - 1);
  if (column == std::string::npos || line == std::string::npos) return "";
  return fmt::format("file={},line={},col={},", percent_encoded(where.substr(0, line), true),
                     where.substr(line + 1, column - line - 1), where.substr(column + 1));
}

std::string counts_by_case(const Results& results) {
  std::string text = "| case | held | failed | known deviations | seconds |\n|---|---:|---:|---:|---:|\n";
  for (const CaseResult& result : results.cases) {
    std::map<GateAnswer, int> counts;
    for (const GateResult& gate : result.gates) ++counts[gate.answer];
    double seconds = 0;
    for (const Cell& cell : result.cells) seconds += cell.wall_seconds;
    text += fmt::format("| {} | {} | {} | {} | {:.2f} |\n", plain(result.definition.id), counts[GateAnswer::held],
                        counts[GateAnswer::failed] + counts[GateAnswer::not_checked] +
                            counts[GateAnswer::unexpected_pass] + !result.error.empty(),
                        counts[GateAnswer::known_deviation], seconds);
  }
  return text;
}

}  // namespace

std::string job_summary(const Results& results, std::size_t longest) {
  const std::vector<Failure> rows = failures(results);
  std::string text = fmt::format("## Rigor: {}\n\n{}\n", rows.empty() ? "all gates hold" : "gates fell short",
                                 plain(gate_summary(results)));
  if (!rows.empty())
    text +=
        "| case | engine | dt [s] | gate | found | wanted | worst instant | because "
        "|\n|---|---|---|---|---|---|---|---|\n";
  std::size_t shown = 0;
  for (const Failure& row : rows) {
    const std::string line =
        fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", plain(row.case_id), plain(row.engine), plain(row.dt),
                    plain(row.what), plain(row.found), plain(row.limit), plain(row.worst), plain(row.because));
    if (text.size() + line.size() > longest) break;
    text += line, ++shown;
  }
  if (shown < rows.size()) text += fmt::format("\n{} more are in results.json and junit.xml.\n", rows.size() - shown);
  const std::string counts = "\n" + counts_by_case(results);
  return text.size() + counts.size() <= longest ? text + counts : text;
}

std::string annotations(const std::vector<Failure>& rows) {
  std::string text;
  for (const Failure& row : rows) {
    const std::string title = fmt::format("{}: {}", row.case_id, row.what);
    text +=
        fmt::format("::error {}title={}::{}\n", place_of(row.where), percent_encoded(title, true),
                    percent_encoded(fmt::format("{}{}{}{}{}", row.engine, row.dt.empty() ? "" : " at dt = " + row.dt,
                                                row.found.empty() ? "" : ": found " + row.found,
                                                row.limit.empty() ? "" : ", wanted " + row.limit,
                                                (row.worst.empty() ? "" : "; worst " + row.worst) +
                                                    (row.because.empty() ? "" : "; because: " + row.because)),
                                    false));
  }
  return text;
}

std::string warnings(const Results& results) {
  std::string text;
  for (const CaseResult& result : results.cases) {
    for (const GateResult& answer : result.gates) {
      if (answer.caveat.empty()) continue;
      const Gate& gate = result.definition.gates[answer.gate];
      text += fmt::format("::warning {}title={}::{}\n", place_of(gate.where),
                          percent_encoded(result.definition.id + ": " + gate.metric, true),
                          percent_encoded(answer.text + ", but " + answer.caveat, false));
    }
  }
  return text;
}

}  // namespace rigor::inline report
