#include "cases/cli/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cases/cli/commands.h"
#include "cases/metrics/metric.h"
#include "cases/report/trace/trace_formats.h"
#include "cases/truth/provenance.h"
#include "cases/truth/truth.h"

namespace rigor::inline cli {
namespace {

using Cells = std::vector<std::string>;

// Text in which no character has a meaning in Markdown.
std::string plain_markdown(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string_view("\\`*_<>[]|$#{}").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

// The same as a sentence: it begins with a capital.
std::string sentence_markdown(const std::string& text) {
  std::string out = plain_markdown(text);
  if (!out.empty()) out[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(out[0])));
  return out;
}

// Code in a cell of a table, where a bar would end the cell.
std::string code_markdown(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? "\\|" : std::string(1, c);
  return "`" + out + "`";
}

std::string row_markdown(const Cells& cells) { return fmt::format("| {} |\n", fmt::join(cells, " | ")); }

std::string table_markdown(const Cells& head, const std::vector<Cells>& rows) {
  if (rows.empty()) return "";
  std::string text = row_markdown(head) + row_markdown(Cells(head.size(), "---"));
  for (const Cells& row : rows) text += row_markdown(row);
  return text + "\n";
}

std::vector<Cells> option_cells(const CommandRow& row) {
  std::vector<Cells> rows;
  for (const OptionFact& option : options_of(row))
    rows.push_back(
        {code_markdown(option.name + (option.type.empty() ? "" : " " + option.type)), plain_markdown(option.meaning)});
  return rows;
}

std::string command_pages() {
  std::string text = "# Commands\n\n`rigor COMMAND [words] [options]`. `rigor help COMMAND` prints the same text.\n\n";
  for (const CommandRow& row : commands()) {
    text += fmt::format("## rigor {}\n\n{}.\n\n", row.name, sentence_markdown(row.summary));
    if (!row.words.empty()) text += fmt::format("`{}`: {}\n\n", row.words, plain_markdown(row.words_summary));
    text += table_markdown({"Option", "Meaning"}, option_cells(row));
    for (const Example& example : row.examples)
      text += fmt::format("{}:\n\n```sh\n{}\n```\n\n", sentence_markdown(example.does), example.call);
  }
  text += "## Exit codes\n\n";
  std::vector<Cells> exits, variables;
  for (const NamedFact& fact : exit_codes()) exits.push_back({fact.name, fact.meaning});
  for (const NamedFact& fact : environment_variables()) variables.push_back({"`" + fact.name + "`", fact.meaning});
  return text + table_markdown({"Code", "Meaning"}, exits) + "## Environment\n\n" +
         table_markdown({"Variable", "Meaning"}, variables);
}

std::string metric_pages() {
  std::vector<Cells> of_runs, across;
  for (const MetricRow& row : metrics()) {
    of_runs.push_back({code_markdown(row.name), plain_markdown(row.unit), plain_markdown(row.summary),
                       row.higher_is_better ? "higher" : "lower"});
  }
  for (const CrossMetricRow& row : cross_metrics())
    across.push_back({code_markdown(row.name), plain_markdown(row.unit), plain_markdown(row.summary)});
  return "# Metrics\n\nA gate names a metric by its key `metric`. Units are SI; 1 is a pure number.\n\n## Of one "
         "run\n\n" +
         table_markdown({"Metric", "Unit", "Meaning", "Better"}, of_runs) + "## Across the cells of a case\n\n" +
         table_markdown({"Metric", "Unit", "Meaning"}, across);
}

std::string truth_pages() {
  std::vector<Cells> rows;
  for (const TruthRow& row : truths())
    rows.push_back({code_markdown(row.name), plain_markdown(row.summary), plain_markdown(provenance_of(row.name))});
  return "# Truths\n\nA case names its truth by `[truth] kind`. With `none` only conservation is judged.\n\n" +
         table_markdown({"Kind", "Motion", "Where it comes from"}, rows);
}

std::string values_of(const OptionInfo& option) {
  if (!option.choices.empty()) return fmt::format("{}", fmt::join(option.choices, ", "));
  return fmt::format("{}{} to {}", option.whole ? "whole numbers, " : "", option.min, option.max);
}

std::string method_pages(const std::string& engine, const MethodInfo& method) {
  std::string text =
      fmt::format("### {}:{}\n\n{}. Order {}{}{}{}.\n\n", engine, method.name, sentence_markdown(method.summary),
                  method.order, method.symplectic ? ", symplectic" : "", method.symmetric ? ", symmetric" : "",
                  method.adaptive ? ", adaptive" : "");
  if (!method.twin_of.empty()) text += fmt::format("A scheme replica (twin) of {}.\n\n", method.twin_of);
  std::vector<Cells> rows;
  for (const OptionInfo& option : method.options)
    rows.push_back({code_markdown(option.name), plain_markdown(values_of(option)), plain_markdown(default_text(option)),
                    plain_markdown(option.meaning)});
  return text + table_markdown({"Option", "Values", "Default", "Meaning"}, rows);
}

std::string engine_pages(const EngineTable& engines) {
  std::string text =
      "# Engines and methods\n\nA run is named `ENGINE[:METHOD][,key=value...][@TRACK]`. The engines are those of the "
      "build that made this page. The first method of an engine is its default.\n\n";
  for (const EngineInfo& engine : engines.infos()) {
    text += fmt::format("## {}\n\nVersion {}, {} precision.", engine.name, plain_markdown(engine.version),
                        engine.precision);
    if (std::isfinite(engine.max_rotation_per_step))
      text += fmt::format(" A body turns by at most {:.3g} rad in one step.", engine.max_rotation_per_step);
    text += "\n\n";
    for (const MethodInfo& method : engine.methods) text += method_pages(engine.name, method);
  }
  return text;
}

std::string trajectory_pages() {
  std::vector<Cells> formats;
  for (const auto& format : trace_formats())
    formats.push_back({code_markdown(format.name), plain_markdown(format.summary)});
  return fmt::format(
             "# Trajectories\n\nA CSV file has one row per body and instant, t = 0 first, with 17 significant digits: "
             "`time,body,{}`. `rigor truth` adds a last column `error`.\n\nPositions are in m, velocities in m/s, "
             "angular "
             "velocities in rad/s, all in W. The quaternion takes B to W.\n\n",
             fmt::join(kColumnNames, ",")) +
         table_markdown({"Format of `rigor trace`", "Content"}, formats);
}

}  // namespace

std::string reference_text(const EngineTable& engines) {
  return command_pages() + metric_pages() + truth_pages() + engine_pages(engines) + trajectory_pages();
}

}  // namespace rigor::inline cli
