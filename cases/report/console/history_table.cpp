#include "cases/report/console/history_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "cases/analysis/change_point.h"
#include "cases/report/wording/wording.h"

namespace rigor {
namespace {

constexpr std::size_t kMostShown = 60, kLongestLine = 40;  // cells without a word for them; values of a sparkline
constexpr double kSameBits = 1.001;  // four digits are kept of an error, which is the same in each run of one program
constexpr double kNoise = 1e-12;     // what is smaller is rounding
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Series {
  std::vector<double> values;        // of each entry of the history; not a number where it has none
  std::vector<std::size_t> changes;  // entries with which a new level begins
};

struct CellHistory {
  std::string name, metric;
  Series error, cost;
  std::string status_change;
  bool has_changed() const { return !error.changes.empty() || !cost.changes.empty() || !status_change.empty(); }
};

// The metric that the last entry has, the one that says most first.
std::string metric_of(const std::vector<HistoryEntry>& history, const std::string& key) {
  for (auto entry = history.rbegin(); entry != history.rend(); ++entry) {
    const auto cell = entry->cells.find(key);
    if (cell == entry->cells.end() || cell->second.metrics.empty()) continue;
    const auto& metrics = cell->second.metrics;
    for (const char* name : {"position_error", "orientation_error", "energy_drift_synchronised"}) {
      const auto found = metrics.find(name);
      if (found != metrics.end() && found->second > kNoise) return name;
    }
    return metrics.begin()->first;
  }
  return "";
}

// Errors repeat bit for bit, so that each change of theirs is one of the program.
std::vector<std::size_t> changes_of_errors(const std::vector<double>& values) {
  std::vector<std::size_t> changes;
  double before = kNone;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    const double a = std::max(kNoise, std::abs(before)), b = std::max(kNoise, std::abs(values[i]));
    const bool is_same = a == b || std::max(a, b) / std::min(a, b) <= kSameBits;
    if (!std::isnan(before) && !is_same) changes.push_back(i);
    before = values[i];
  }
  return changes;
}

// Costs are measured, on the machine of the last entry alone; what there is beyond their noise Pettitt's test says.
std::vector<std::size_t> changes_of_costs(const std::vector<double>& values) {
  std::vector<double> there;
  std::vector<std::size_t> index, changes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i])) there.push_back(values[i]), index.push_back(i);
  }
  for (const std::size_t change : change_points(there)) changes.push_back(index[change]);
  return changes;
}

CellHistory history_of(const std::vector<HistoryEntry>& history, const std::string& key) {
  CellHistory found{key, metric_of(history, key), {}, {}, ""};
  std::replace(found.name.begin(), found.name.end(), '\t', ' ');
  std::string status;
  for (const HistoryEntry& entry : history) {
    const auto cell = entry.cells.find(key);
    const bool is_there = cell != entry.cells.end();
    const auto metric = is_there ? cell->second.metrics.find(found.metric) : decltype(cell->second.metrics.end()){};
    const bool has_error = is_there && metric != cell->second.metrics.end();
    found.error.values.push_back(has_error ? metric->second : kNone);
    const bool is_comparable = is_there && entry.machine == history.back().machine && cell->second.cost;
    found.cost.values.push_back(is_comparable ? *cell->second.cost : kNone);
    if (is_there && !status.empty() && cell->second.status != status)
      found.status_change = fmt::format("{} -> {} at {}", status, cell->second.status, entry.commit);
    if (is_there) status = cell->second.status;
  }
  found.error.changes = changes_of_errors(found.error.values);
  found.cost.changes = changes_of_costs(found.cost.values);
  return found;
}

double median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return kNone;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// "x2.1 at 1a2b3c (2026-01-31)", of the levels before and after.
std::string change_text(const Series& series, std::size_t which, const std::vector<HistoryEntry>& history) {
  const auto at = [&](std::size_t i) { return series.values.begin() + static_cast<std::ptrdiff_t>(i); };
  const std::size_t begin = which == 0 ? 0 : series.changes[which - 1], middle = series.changes[which],
                    end = which + 1 < series.changes.size() ? series.changes[which + 1] : series.values.size();
  const double before = median({at(begin), at(middle)}), after = median({at(middle), at(end)});
  const HistoryEntry& entry = history[middle];
  return fmt::format("{} -> {} at {} ({})", rounded(before), rounded(after), entry.commit.empty() ? "?" : entry.commit,
                     entry.date.substr(0, 10));
}

std::string series_text(const std::string& name, const Series& series, const std::vector<HistoryEntry>& history) {
  constexpr std::size_t kMostChanges = 3;
  const double last = median({series.values.end() - 1, series.values.end()});
  std::string text = fmt::format("    {:<28} {}  {}", name, sparkline(series.values),
                                 std::isnan(last) ? "none now" : "now " + rounded(last));
  const std::size_t count = series.changes.size();
  for (std::size_t i = count > kMostChanges ? count - kMostChanges : 0; i < count; ++i)
    text += (i + kMostChanges == count || i == 0 ? "  * " : ", ") + change_text(series, i, history);
  return text + "\n";
}

std::string text_of(const CellHistory& cell, const std::vector<HistoryEntry>& history) {
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
  std::set<std::string> keys;
  for (const HistoryEntry& entry : history) {
    for (const auto& [key, cell] : entry.cells) keys.insert(key);
  }
  const bool shows_all = !words.empty() || keys.size() <= kMostShown;
  std::string text;
  std::size_t unchanged = 0, shown = 0;
  for (const std::string& key : keys) {
    const bool is_named = std::any_of(words.begin(), words.end(),
                                      [&](const std::string& word) { return key.find(word) != std::string::npos; });
    if (!words.empty() && !is_named) continue;
    const CellHistory cell = history_of(history, key);
    unchanged += !cell.has_changed(), shown += shows_all || cell.has_changed();
    if (shows_all || cell.has_changed()) text += text_of(cell, history);
  }
  std::string head = fmt::format("{} entries, from {} ({}) to {} ({}); costs on {}\n", history.size(),
                                 history.front().commit, history.front().date.substr(0, 10), history.back().commit,
                                 history.back().date.substr(0, 10), history.back().machine);
  head += "* a change: of an error, which repeats bit for bit, any; of a cost one beyond its noise (Pettitt's test)\n";
  return head + text + fmt::format("{} cells shown, {} without a change\n", shown, unchanged);
}

}  // namespace rigor
