// report.md: the console's table as Markdown, a table for each further step size below, then the machine and settings;
// of many cases without the tables, and what several have in common is said once.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "cases/report/console/console_table.h"
#include "cases/report/json/leave_out_details.h"
#include "cases/report/json/machine.h"
#include "cases/report/markdown/markdown_text.h"
#include "cases/report/markdown/said_before.h"
#include "cases/report/reports.h"
#include "cases/report/wording/comparison.h"
#include "cases/report/wording/explained_error.h"
#include "cases/report/wording/explanations/explanation.h"
#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/printed_command.h"
#include "cases/report/wording/recommendation.h"
#include "cases/report/wording/recorded_error.h"
#include "cases/report/wording/verdict_matrix.h"

namespace rigor::inline report {
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
    for (const std::string& cell : cells.rows[row]) text += cell.empty() ? "|" : fmt::format(" {} |", plain(cell));
    text += "\n";
    if (row > 0) continue;
    text += "|---|";
    for (std::size_t column = 1; column < cells.rows[0].size(); ++column) text += "---:|";
    text += "\n";
  }
  return text;
}

// The tables of many cases would be too long to read, or for a forge to show. The matrix above has their numbers.
bool has_tables(const Results& results) { return results.cases.size() <= kMostCasesInDetail; }

// The command that says which known mistake a failed run's error looks like.
std::string diagnosis_line(const CaseResult& result) {
  std::set<std::string> runs;
  for (const GateResult& gate : result.gates) {
    if (gate.answer == GateAnswer::failed && !gate.engine.empty()) runs.insert(gate.engine);
  }
  std::string text;
  for (const std::string& run : runs)
    text += fmt::format("{} `{}`", text.empty() ? "" : ",", diagnose_command_text(result.definition.id, run));
  return text.empty() ? "" : "\nWhich known mistake the error looks like:" + text + "\n";
}

// The answers of gates, except those that held without caveat, one paragraph each.
std::vector<std::string> answers_in_full(const CaseResult& result) {
  std::vector<std::string> lines;
  for (const GateResult& gate : result.gates) {
    const std::string kind = kind_of(result.definition.gates[gate.gate]);
    if (!gate.caveat.empty())
      lines.push_back(fmt::format("- {} held: {}, **but {}**", kind, plain(gate.text), plain(gate.caveat)));
    if (gate.answer == GateAnswer::held || gate.answer == GateAnswer::not_recorded) continue;
    lines.push_back(fmt::format("- {} {}: {}", kind, word_of(gate.answer), plain(gate.text)));
  }
  return lines;
}

// The same with known deviations of one reason together, by their runs and steps.
std::vector<std::string> answers_in_short(CaseResult result) {
  std::map<std::string, std::string> known;  // what deviates, by the reasons that end its text
  for (const GateResult& gate : result.gates) {
    if (gate.answer != GateAnswer::known_deviation) continue;
    std::string& list = known[gate.text.substr(std::min(gate.text.size(), gate.text.find(" (")))];
    const std::string& metric = result.definition.gates[gate.gate].metric;
    list += fmt::format("{}{} of {} at dt = {}", list.empty() ? "" : ", ", metric, gate.engine, gate.dt);
  }
  std::erase_if(result.gates, [](const GateResult& gate) { return gate.answer == GateAnswer::known_deviation; });
  std::vector<std::string> lines = answers_in_full(result);
  for (const auto& [reasons, list] : known)
    lines.push_back(fmt::format("- {}: {}{}", word_of(GateAnswer::known_deviation), plain(list), plain(reasons)));
  return lines;
}

std::string headline(const Results& results, const CaseResult& result, SaidBefore& said) {
  const bool is_long = !has_tables(results);
  const auto told = [&](const std::string& paragraph) { return is_long ? said.shortened(paragraph) : paragraph; };
  std::string text = fmt::format("## {}: {}\n\n{}\n\n", plain(result.definition.id), plain(result.definition.title),
                                 told(plain(truth_sentence(result))));
  if (!is_long) text += table(results, result, coarsest_dt(result)) + "\n";
  if (const TextTable recorded = recorded_errors(results, result); !recorded.rows.empty())
    text += table(recorded) + "\n";
  for (const Message& message : explanations(results, result)) text += told(plain(message.text)) + "\n\n";
  for (const Message& message : work_precision_messages(results, result)) text += told(plain(message.text)) + "\n\n";
  for (const std::string& line : is_long ? answers_in_short(result) : answers_in_full(result))
    text += told(line) + "\n";
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

const SettingsInForce* settings_of_run(const Results& results, std::size_t run) {
  for (const CaseResult& result : results.cases) {
    for (const Cell& cell : result.cells) {
      if (cell.run == run && !cell.settings.empty()) return &cell.settings;
    }
  }
  return nullptr;
}

std::string list_of(const SettingsInForce& settings) {
  std::string text;
  for (const auto& [name, value] : settings) text += fmt::format(" {} = {};", plain(name), plain(value));
  return text;
}

// What a run sets apart from another one of the same names of settings, where that is shorter.
std::string list_beside(const SettingsInForce& settings, const SettingsInForce& other, const std::string& name) {
  SettingsInForce differing;
  for (std::size_t i = 0; i < settings.size() && settings.size() == other.size(); ++i) {
    if (settings[i].first != other[i].first) return list_of(settings);
    if (settings[i] != other[i]) differing.push_back(settings[i]);
  }
  const std::string text = fmt::format(" as {}{}{}", plain(name), differing.empty() ? "" : ", but", list_of(differing));
  return settings.size() == other.size() && text.size() < list_of(settings).size() ? text : list_of(settings);
}

std::string settings(const Results& results) {
  std::vector<std::pair<std::string, const SettingsInForce*>> told;  // by the run's name
  std::string text;
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    const SettingsInForce* own = settings_of_run(results, run);
    if (!own) continue;
    std::string list = list_of(*own);
    for (const auto& [name, other] : told) {
      const std::string beside = list_beside(*own, *other, name);
      if (beside.size() < list.size()) list = beside;
    }
    told.emplace_back(results.runs[run].text, own);
    text += fmt::format("- {}{}:{}\n", plain(results.runs[run].text), precision_after(results, run), list);
  }
  return text;
}

// An engine's other runs beside its first, which the matrix above shows. Results equal to the first are not repeated.
TextTable matrix_of_engine(const Results& results, Words words, const std::vector<std::size_t>& runs) {
  TextTable matrix = verdict_matrix(results, words, runs);
  matrix.heading = fmt::format("To be read as above; = is as {}, and cases in which all are so are left out.",
                               results.runs[runs.front()].text);
  for (std::vector<std::string>& row : matrix.rows) {
    std::replace(row.begin() + 2, row.end(), std::string(row[1]), std::string("="));
    row.erase(row.begin() + 1);
  }
  const auto says_nothing = [](const std::vector<std::string>& row) {
    return std::all_of(row.begin() + 1, row.end(), [](const std::string& cell) { return cell.empty() || cell == "="; });
  };
  std::erase_if(matrix.rows, says_nothing);
  return matrix;
}

// If there are many runs, one per engine is shown; the others of each engine are behind a line to open.
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
    const TextTable others = matrix_of_engine(results, words, own);
    const std::string beside = fmt::format("{}: {} runs beside {}", engine, own.size() - 1, results.runs[first].text);
    text += others.rows.size() == 1
                ? fmt::format("\n{}, which all end as it does in every case.\n", plain(beside))
                : fmt::format("\n<details><summary>{}</summary>\n\n{}\n</details>\n", plain(beside), table(others));
  }
  return text;
}

}  // namespace

std::string markdown_report(const Results& results) {
  std::string text = "# Rigor: which engine, which step, and why\n\n";
  for (const CaseResult& result : results.cases) {
    if (const std::string other = not_the_same_robot(result.definition.losses); !other.empty())
      text += fmt::format("**{}: {}**\n\n", plain(result.definition.id), plain(other));
  }
  const auto first = recommendation(results);
  if (first) text += fmt::format("**{}** {}\n\n", plain(first->text), plain(first->more));
  for (const Finding& found : findings(results)) {
    if (first && found.topic == first->topic) continue;
    text += fmt::format("- **{}:** {}\n", found.topic, plain(found.text));
    if (!found.more.empty()) text += fmt::format("  <br>{}\n", plain(found.more));
  }
  const Words words = has_tables(results) ? Words::all : Words::few;
  text += "\n" + matrices(results, words) + "\n" + plain(gate_summary(results)) + "\n";
  SaidBefore said;
  for (const CaseResult& result : results.cases) text += headline(results, result, said) + "\n";
  text += has_tables(results) ? tables(results)
                              : "An ellipsis stands for words that an earlier case has in full. A case's tables, and "
                                "all that is said of it: `rigor run CASE`, or report.html.\n\n";
  const Machine machine = this_machine();
  text += fmt::format(
      "# Settings in force\n\nAs read back from each engine, in the first case it ran.\n\n{}\n"
      "rigor {} on {} ({} cores), {}, {} build; {:.1f} s.\n",
      settings(results), machine.program_version, machine.cpu, machine.cores, machine.compiler, machine.build_type,
      results.wall_seconds);
  return text;
}

}  // namespace rigor::inline report
