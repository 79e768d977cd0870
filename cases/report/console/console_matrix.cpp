#include "cases/report/console/console_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cases/report/layout.h"
#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/verdict_matrix.h"
#include "cases/report/wording/wording.h"
#include "cases/results/main_error.h"

namespace rigor::inline report {
namespace {

constexpr std::size_t kCaseColumn = 23, kMatrixColumn = 11;  // 100 characters with seven columns

std::string right_aligned(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, width_of(text)), ' ') + text;
}

// 33.3mm, 1.6prad, 26.9%: eight characters at most.
std::string short_quantity(double value, const std::string& metric) {
  const double size = std::abs(value);
  if (!std::isfinite(size)) return "inf";
  if (metric.starts_with("energy")) return size < 1e-11 ? "0%" : rounded(100 * size) + "%";
  const char* unit = metric.starts_with("orientation") ? "rad" : "m";
  if (size < 1e-12) return std::string("0") + unit;  // rounding
  if (size >= 1e4) return rounded(size) + unit;
  for (const auto& [factor, prefix] : {std::pair{1.0, ""}, {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}}) {
    constexpr double kRoundsUp = 0.9995;  // to three digits
    if (size >= kRoundsUp * factor) return fmt::format("{:.3g}{}{}", size / factor, prefix, unit);
  }
  return fmt::format("{:.3g}p{}", size / 1e-12, unit);
}

// Between sign and number stands the shade: it takes no room.
std::string cell_text(const CaseResult& result, const Cell& cell, const std::string& metric) {
  const std::string sign = sign_of(cell);
  if (cell.status == Status::diverged) return fmt::format("{} {:.2f}s", sign, cell.stability.time);
  const auto found = cell.metrics.find(metric);
  const bool has_number = found != cell.metrics.end() && found->second.not_applicable.empty();
  if (cell.status == Status::unsupported) return sign;
  if (!has_number) return sign + word_of(cell.status);
  const std::string quantity = short_quantity(found->second.value, metric);
  return sign + shade_of(result, cell) + (found->second.is_held_to_itself ? fmt::format("({})", quantity) : quantity);
}

// A run's name in lines of a column's width, broken behind ':' and before '@', at '-', ',' and '=', else anywhere.
std::vector<std::string> head_lines(const std::string& name) {
  constexpr std::size_t kWidth = kMatrixColumn - 1;
  std::vector<std::string> parts = {""};
  for (const char c : name) {
    if (c == '@') parts.emplace_back();
    parts.back() += c;
    if (c == ':' || c == '-' || c == ',' || c == '=' || parts.back().size() == kWidth) parts.emplace_back();
  }
  std::vector<std::string> lines = {""};
  for (const std::string& part : parts) {
    const bool is_method = lines.back().ends_with(':');  // on separate lines
    if (!lines.back().empty() && (is_method || lines.back().size() + part.size() > kWidth)) lines.emplace_back();
    lines.back() += part;
  }
  if (lines.back().empty()) lines.pop_back();
  return lines;
}

std::string head(const Results& results, const std::vector<std::size_t>& runs) {
  std::vector<std::vector<std::string>> columns;
  std::size_t height = 0;
  for (const std::size_t run : runs) {
    columns.push_back(head_lines(results.runs[run].text));
    height = std::max(height, columns.back().size());
  }
  std::string text;
  for (std::size_t line = 0; line < height; ++line) {
    std::string row = line + 1 == height ? fmt::format("{:<{}}", "case", kCaseColumn) : std::string(kCaseColumn, ' ');
    for (const auto& column : columns) {
      const std::size_t blank = height - column.size();  // names stand on the same lowest line
      row += right_aligned(line < blank ? "" : column[line - blank], kMatrixColumn);
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

bool none_supports(const CaseResult& result, const std::vector<std::size_t>& runs, const StepSize& dt) {
  const auto is_shown = [&](const Cell& cell) {
    return cell.dt == dt && std::find(runs.begin(), runs.end(), cell.run) != runs.end();
  };
  const auto is_possible = [&](const Cell& cell) { return is_shown(cell) && cell.status != Status::unsupported; };
  return std::any_of(result.cells.begin(), result.cells.end(), is_shown) &&
         std::none_of(result.cells.begin(), result.cells.end(), is_possible);
}

std::string panel(const Results& results, const std::vector<std::size_t>& runs) {
  const StepSize headline = headline_dt(results);
  std::string text = head(results, runs), family;
  for (const CaseResult& result : results.cases) {
    const std::string& id = result.definition.id;
    const std::size_t slash = id.rfind('/');
    const std::string of = slash == std::string::npos ? "" : id.substr(0, slash);
    if (of != family) text += of + "\n", family = of;
    const StepSize dt = matrix_dt(result, headline);
    const std::string name = (slash == std::string::npos ? id : " " + id.substr(slash + 1)) +
                             (dt == headline ? "" : fmt::format(" {}", dt.text));
    std::string row = fmt::format("{:<{}}", shortened(name, kCaseColumn), kCaseColumn);
    const std::string metric = main_error(result);
    if (none_supports(result, runs, dt)) {
      text += fmt::format("{} – unsupported by all of these\n", row);
      continue;
    }
    for (const std::size_t run : runs) {
      const auto cell = std::find_if(result.cells.begin(), result.cells.end(),
                                     [&](const Cell& c) { return c.run == run && c.dt == dt; });
      row += right_aligned(cell == result.cells.end() ? "" : cell_text(result, *cell, metric), kMatrixColumn);
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

// Those of at least half of the cases; the others are asked for by single gates. Engines that are not ours first; of
// many runs one an engine.
std::vector<std::size_t> runs_to_show(const Results& results) {
  std::vector<std::size_t> cases_of(results.runs.size());
  for (const CaseResult& result : results.cases) {
    std::vector<bool> is_there(results.runs.size());
    for (const Cell& cell : result.cells) is_there[cell.run] = true;
    for (std::size_t run = 0; run < is_there.size(); ++run) cases_of[run] += is_there[run];
  }
  std::vector<std::size_t> runs;
  for (std::size_t run = 0; run < cases_of.size(); ++run) {
    if (2 * cases_of[run] >= results.cases.size()) runs.push_back(run);
  }
  if (runs.empty()) runs.resize(results.runs.size()), std::iota(runs.begin(), runs.end(), std::size_t{0});
  std::stable_partition(runs.begin(), runs.end(), [&](std::size_t run) { return !is_in_house(results, run); });
  return readable_columns(results, runs);
}

}  // namespace

std::string console_matrix(const Results& results) {
  const std::vector<std::size_t> runs = runs_to_show(results);
  const std::size_t most =
                        std::clamp((console_width() - kCaseColumn) / kMatrixColumn, std::size_t{1}, kMostMatrixColumns),
                    panels = (runs.size() + most - 1) / most, columns = (runs.size() + panels - 1) / panels;
  std::string text =
      wrapped(fmt::format("dt = {} s, or what stands behind a case: the largest error of the position "
                          "[m]; of the orientation [rad] where nothing moves away; of the energy [%] "
                          "where there is no truth; in brackets, of a truth that the run's own code makes.",
                          headline_dt(results).text),
              0) +
      "\n" + "✓ stable  ≈ drifting  ∩ overlapping  ↑ gaining energy  ↓ collapsed  » tunnelled\n" +
      "✕ blown up at that time, or gate failed  ◆ known deviation  ◇ unexpected pass  – unsupported\n"
      "◐ stable, in part at a lower order  ! invalid, crashed or out of time\n" +
      "error in sizes of the case, or in rad: ░ from 1e-3  ▒ 1e-2  ▓ 1e-1  █ 1\n";
  for (std::size_t first = 0; first < runs.size(); first += columns) {
    const auto begin = runs.begin() + static_cast<long>(first),
               end = runs.begin() + static_cast<long>(std::min(first + columns, runs.size()));
    text += "\n" + panel(results, {begin, end});
  }
  if (runs.size() < results.runs.size()) {
    text += "\n" +
            wrapped(fmt::format("{} more runs, of other methods and tracks or of single cases, stand in the reports; "
                                "--engine NAME:METHOD shows one here.",
                                results.runs.size() - runs.size()),
                    0) +
            "\n";
  }
  return text;
}

}  // namespace rigor::inline report
