// report.md: the console's table as Markdown, a table for each further step size below, then the machine and settings;
// of many cases without the tables.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "cases/report/console/console_table.h"
#include "cases/report/json/leave_out_details.h"
#include "cases/report/json/machine.h"
#include "cases/report/markdown/markdown_text.h"
#include "cases/report/reports.h"
#include "cases/report/wording/comparison.h"
#include "cases/report/wording/explained_error.h"
#include "cases/report/wording/explanation.h"
#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/verdict_matrix.h"

namespace rigor {
namespace {

std::string explained_markdown(const std::vector<ExplainedRow>& rows) {
  if (rows.empty()) return "";
  std::string text =
      "| error explained | position, total [m] | by the scheme [m] | unexplained [m] | orientation, total [rad] | by "
      "the "
      "scheme [rad] | unexplained [rad] | until [s] |\n|---|---:|---:|---:|---:|---:|---:|---:|\n";
  for (const ExplainedRow& row : rows) {
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", plain(row.engine), row.total, row.by_scheme,
                        row.unexplained, row.rotation, row.rotation_by_scheme, row.rotation_unexplained, row.until);
  }
  return text;
}

std::string table(const Results& results, const CaseResult& result, const StepSize& dt) {
  std::string text = fmt::format(
      "| dt = {} s | position error in 1 s [m] | over the run [m] | orientation error [rad] | energy drift, raw [%] | "
      "synchronised [%] | largest stable dt [s] | verdict |\n|---|---:|---:|---:|---:|---:|---:|---|\n",
      dt.text);
  for (const Cell& cell : result.cells) {
    if (cell.dt != dt) continue;
    const RowText row = row_text(results, result, cell);
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", plain(row.engine), row.first_second, row.whole,
                        row.orientation, row.energy, row.energy_synchronised, row.stable_dt, plain(row.verdict));
  }
  for (const std::string& warning : cell_warnings(results, result, dt))
    text += "\n**Warning:** " + plain(warning) + "\n";
  const std::string explained = explained_markdown(explained_rows(results, result, dt));
  return explained.empty() ? text : text + "\n" + explained;
}

std::string table(const TextTable& cells) {
  std::string text = plain(cells.heading) + "\n\n";
  for (std::size_t row = 0; row < cells.rows.size(); ++row) {
    text += "|";
    for (const std::string& cell : cells.rows[row]) text += fmt::format(" {} |", plain(cell));
    text += "\n";
    if (row > 0) continue;
    text += "|---|";
    for (std::size_t column = 1; column < cells.rows[0].size(); ++column) text += "---:|";
    text += "\n";
  }
  return text;
}

// Of many cases their tables would be more than one reads, or a forge shows: the matrix above has their numbers.
bool has_tables(const Results& results) { return results.cases.size() <= kMostCasesInDetail; }

// The command that says which known mistake a failed run's error looks like.
std::string diagnosis_line(const CaseResult& result) {
  std::set<std::string> runs;
  for (const GateResult& gate : result.gates) {
    if (gate.answer == GateAnswer::failed && !gate.engine.empty()) runs.insert(gate.engine);
  }
  std::string text;
  for (const std::string& run : runs)
    text += fmt::format("{} `rigor diagnose {} --engine '{}'`", text.empty() ? "" : ",", result.definition.id, run);
  return text.empty() ? "" : "\nWhich known mistake the error looks like:" + text + "\n";
}

std::string headline(const Results& results, const CaseResult& result) {
  std::string text = fmt::format("## {}: {}\n\n{}\n\n", plain(result.definition.id), plain(result.definition.title),
                                 plain(truth_sentence(result)));
  if (has_tables(results)) text += table(results, result, coarsest_dt(result)) + "\n";
  for (const std::string& sentence : explanations(results, result)) text += plain(sentence) + "\n\n";
  for (const std::string& sentence : work_precision_sentences(results, result)) text += plain(sentence) + "\n\n";
  for (const GateResult& gate : result.gates) {
    const std::string kind = kind_of(result.definition.gates[gate.gate]);
    if (!gate.caveat.empty())
      text += fmt::format("- {} held: {}, **but {}**\n", kind, plain(gate.text), plain(gate.caveat));
    if (gate.answer != GateAnswer::held && gate.answer != GateAnswer::not_recorded)
      text += fmt::format("- {} {}: {}\n", kind, word_of(gate.answer), plain(gate.text));
  }
  return text + diagnosis_line(result);
}

std::string finer_steps(const Results& results, const CaseResult& result) {
  std::string text;
  const StepSize coarsest = coarsest_dt(result);
  for (const StepSize& dt : result.definition.dt) {
    if (dt != coarsest)
      text += fmt::format("### {}, dt = {} s\n\n", plain(result.definition.id), dt.text) + table(results, result, dt) +
              "\n";
  }
  return text;
}

std::string comparisons(const Results& results, const CaseResult& result) {
  std::string text;
  for (const TextTable& cells : comparison_tables(results, result)) text += table(cells) + "\n";
  return text.empty() ? "" : fmt::format("## {}\n\n", plain(result.definition.id)) + text;
}

std::string tables(const Results& results) {
  std::string text = "# Other step sizes\n\n";
  for (const CaseResult& result : results.cases) text += finer_steps(results, result);
  text += "# Work, precision and spread\n\n";
  for (const CaseResult& result : results.cases) text += comparisons(results, result);
  return text;
}

std::string precision_after(const Results& results, std::size_t run) {
  const auto engine = std::find_if(results.engines.begin(), results.engines.end(),
                                   [&](const EngineInfo& info) { return info.name == results.runs[run].engine; });
  return engine != results.engines.end() && engine->precision == "single" ? " (single precision, bounds wider by it)"
                                                                          : "";
}

std::string settings(const Results& results) {
  std::string text;
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    for (const CaseResult& result : results.cases) {
      const auto cell = std::find_if(result.cells.begin(), result.cells.end(),
                                     [&](const Cell& c) { return c.run == run && !c.settings.empty(); });
      if (cell == result.cells.end()) continue;
      text += fmt::format("- {}{}:", plain(results.runs[run].text), precision_after(results, run));
      for (const auto& [name, value] : cell->settings) text += fmt::format(" {} = {};", plain(name), plain(value));
      text += "\n";
      break;
    }
  }
  return text;
}

// Of many runs one an engine, and each engine's own behind a line to open.
std::string matrices(const Results& results, Words words) {
  std::vector<std::size_t> all(results.runs.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<std::size_t> shown = readable_columns(results, all);
  std::string text = table(verdict_matrix(results, words, shown));
  if (shown.size() == all.size()) return text;
  for (const std::size_t first : shown) {
    const std::string& engine = results.runs[first].engine;
    std::vector<std::size_t> own = all;
    std::erase_if(own, [&](std::size_t run) { return results.runs[run].engine != engine; });
    if (own.size() == 1) continue;
    text += fmt::format("\n<details><summary>{}: all {} of its runs</summary>\n\n{}\n</details>\n", plain(engine),
                        own.size(), table(verdict_matrix(results, words, own)));
  }
  return text;
}

}  // namespace

std::string markdown_report(const Results& results) {
  std::string text = "# Rigor: how right each engine was\n\n";
  for (const Finding& found : findings(results)) {
    text += fmt::format("- **{}:** {}\n", found.topic, plain(found.text));
    if (!found.more.empty()) text += fmt::format("  <br>{}\n", plain(found.more));
  }
  const Words words = has_tables(results) ? Words::all : Words::few;
  text += "\n" + matrices(results, words) + "\n" + plain(gate_summary(results)) + "\n";
  for (const CaseResult& result : results.cases) text += headline(results, result) + "\n";
  text += has_tables(results) ? tables(results) : "A case's tables: `rigor run CASE`, or report.html.\n\n";
  const Machine machine = this_machine();
  text += fmt::format(
      "# Settings in force\n\nAs read back from each engine, in the first case it ran.\n\n{}\n"
      "rigor {} on {} ({} cores), {}, {} build; {:.1f} s.\n",
      settings(results), machine.program_version, machine.cpu, machine.cores, machine.compiler, machine.build_type,
      results.wall_seconds);
  return text;
}

}  // namespace rigor
