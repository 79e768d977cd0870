#include "cases/cli/help.h"

#include <fmt/format.h>

#include <algorithm>

#include "cases/report/layout.h"

namespace rigor::inline cli {
namespace {

using Rows = std::vector<std::pair<std::string, std::string>>;

// Two columns. A left one that is too long gets a line of its own.
std::string columns(const Rows& rows) {
  constexpr std::size_t kMost = 30;
  std::size_t width = 0;
  for (const auto& [left, right] : rows) width = std::max(width, std::min(left.size(), kMost));
  std::string text;
  for (const auto& [left, right] : rows) {
    const std::size_t indent = width + 4;
    const std::string gap =
        left.size() > width ? "\n" + std::string(indent, ' ') : std::string(width + 2 - left.size(), ' ');
    text += "  " + left + gap + wrapped(right, indent) + "\n";
  }
  return text;
}

Rows option_rows(const CommandRow& row) {
  Rows rows;
  for (const OptionFact& option : options_of(row))
    rows.emplace_back(option.name + (option.type.empty() ? "" : " " + option.type), option.meaning);
  rows.emplace_back("-h, --help", "print this and exit");
  return rows;
}

}  // namespace

std::string help_text() {
  Rows rows;
  for (const CommandRow& row : commands()) rows.emplace_back(row.name, row.summary);
  return wrapped("Rigor measures how accurate rigid-body simulators are.", 0) +
         "\n\nUsage: rigor COMMAND [words] [options]\n\nCommands:\n" + columns(rows) + "\nOptions:\n" +
         columns({{"-h, --help", "print this and exit"}, {"--version", "print the versions of all parts and exit"}}) +
         "\nExamples:\n  rigor run springs/fixed-spring\n  rigor list cases\n  rigor help run\n";
}

std::string help_text(const CommandRow& row) {
  std::string text = wrapped(fmt::format("rigor {}: {}", row.name, row.summary), 2) + "\n\nUsage: rigor " + row.name;
  if (!row.words.empty()) text += " [" + row.words + "...]";
  text += " [options]\n\n";
  if (!row.words.empty()) text += columns({{row.words, row.words_summary}}) + "\n";
  text += "Options:\n" + columns(option_rows(row)) + "\nExamples:\n";
  for (const Example& example : row.examples)
    text += fmt::format("  {}\n      {}\n", example.call, wrapped(example.does, 6));
  return text;
}

std::string first_steps() {
  std::string text =
      "which command? Try one of these:\n" +
      columns({{"rigor run springs/fixed-spring", "run one case by every engine and write a report to out/"},
               {"rigor list", "list cases, engines, integrators, metrics and truths"},
               {"rigor new my-case", "write a case of your own, ready to run"},
               {"rigor gate --quick", "exit 1 if an engine is less accurate than recorded"},
               {"rigor --help", "list all commands"}});
  text.pop_back();  // the caller ends the line
  return text;
}

}  // namespace rigor::inline cli
