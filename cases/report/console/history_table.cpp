#include "cases/report/console/history_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/analysis/cell_history.h"
#include "cases/report/wording/wording.h"

namespace rigor::inline report {
namespace {

constexpr std::size_t kMostShown = 60, kLongestLine = 40;  // cells without a word for them; values of a sparkline

// "1.2 -> 2.5 at 1a2b3c (2026-01-31)", of the levels before and after.
std::string change_text(const CellSeries& series, std::size_t which, const std::vector<HistoryEntry>& history) {
  const LevelChange change = level_change(series, which);
  const HistoryEntry& entry = history[change.entry];
  return fmt::format("{} -> {} at {} ({})", rounded(change.before), rounded(change.after),
                     entry.commit.empty() ? "?" : entry.commit, entry.date.substr(0, 10));
}

std::string series_text(const std::string& name, const CellSeries& series, const std::vector<HistoryEntry>& history) {
  constexpr std::size_t kMostChanges = 3;
  const double last = median_of({series.values.end() - 1, series.values.end()});
  std::string text = fmt::format("    {:<28} {}  {}", name, sparkline(series.values),
                                 std::isnan(last) ? "none now" : "now " + rounded(last));
  const std::size_t count = series.changes.size();
  for (std::size_t i = count > kMostChanges ? count - kMostChanges : 0; i < count; ++i)
    text += (i + kMostChanges == count || i == 0 ? "  * " : ", ") + change_text(series, i, history);
  return text + "\n";
}

std::string lines_of(const CellHistory& cell, const std::vector<HistoryEntry>& history) {
  std::string text = "  " + cell.name + "\n";
  if (!cell.status_change.empty()) text += fmt::format("    {:<28} * {}\n", "status", cell.status_change);
  if (!cell.metric.empty()) text += series_text(cell.metric, cell.error, history);
  const auto has_value = [](double value) { return !std::isnan(value); };
  if (std::any_of(cell.cost.values.begin(), cell.cost.values.end(), has_value))
    text += series_text("cost [s/s]", cell.cost, history);
  return text;
}

}  // namespace

std::string sparkline(const std::vector<double>& values) {
  static constexpr const char* kHeights[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const double value : values) {
    if (std::isfinite(value)) least = std::min(least, value), most = std::max(most, value);
  }
  const bool is_log = least > 0;
  const auto height = [&](double value) {
    if (most / std::max(least, 1e-300) < 1.0001) return 0.5;
    return is_log ? std::log(value / least) / std::log(most / least) : (value - least) / (most - least);
  };
  std::string text;
  for (std::size_t i = values.size() > kLongestLine ? values.size() - kLongestLine : 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) {
      text += " ";
    } else {
      text +=
          std::isfinite(values[i]) ? kHeights[static_cast<int>(std::clamp(height(values[i]), 0.0, 1.0) * 7.99)] : "x";
    }
  }
  return text;
}

std::string history_table(const std::vector<HistoryEntry>& history, const std::vector<std::string>& words) {
  if (history.empty()) return "the history is empty: rigor history add DIR begins it\n";
  const std::vector<CellHistory> cells = cell_histories(history, words);
  const bool shows_all = !words.empty() || cells.size() <= kMostShown;
  std::string text;
  std::size_t unchanged = 0, shown = 0;
  for (const CellHistory& cell : cells) {
    unchanged += !cell.has_changed(), shown += shows_all || cell.has_changed();
    if (shows_all || cell.has_changed()) text += lines_of(cell, history);
  }
  std::string head = fmt::format("{} entries, from {} ({}) to {} ({}); costs on {}\n", history.size(),
                                 history.front().commit, history.front().date.substr(0, 10), history.back().commit,
                                 history.back().date.substr(0, 10), history.back().machine);
  head += "* a change: of an error, which repeats bit for bit, any; of a cost one beyond its noise\n";
  return head + text + fmt::format("{} cells shown, {} without a change\n", shown, unchanged);
}

}  // namespace rigor::inline report
