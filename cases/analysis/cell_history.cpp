#include "cases/analysis/cell_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "cases/analysis/change_point.h"

namespace rigor::inline analysis {
namespace {

constexpr double kSameBits = 1.001;    // a history keeps four digits of an error
constexpr double kNoise = 1e-12;       // smaller errors are rounding
constexpr double kNoiseOfCost = 0.01;  // the smallest relative noise of a measured time that counts as real
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The most telling metric of the last entry that has this cell.
std::string metric_of(const std::vector<HistoryEntry>& history, const CellKey& key) {
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

// Errors repeat bit for bit, so each change of an error is a change of the program.
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

// Costs are measured and have noise. The test takes logarithms, so a change counts as a ratio.
std::vector<std::size_t> changes_of_costs(const std::vector<double>& values) {
  std::vector<double> logarithms;
  std::vector<std::size_t> index, changes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] > 0) logarithms.push_back(std::log(values[i])), index.push_back(i);
  }
  for (const std::size_t change : change_points(logarithms, kNoiseOfCost)) changes.push_back(index[change]);
  return changes;
}

CellHistory history_of(const std::vector<HistoryEntry>& history, const CellKey& key) {
  CellHistory found{key.text(" "), metric_of(history, key), {}, {}, ""};
  std::optional<Status> status;
  for (const HistoryEntry& entry : history) {
    const auto cell = entry.cells.find(key);
    const bool is_there = cell != entry.cells.end();
    const auto metric = is_there ? cell->second.metrics.find(found.metric) : decltype(cell->second.metrics.end()){};
    const bool has_error = is_there && metric != cell->second.metrics.end();
    found.error.values.push_back(has_error ? metric->second : kNone);
    const bool is_comparable = is_there && entry.machine == history.back().machine && cell->second.cost;
    found.cost.values.push_back(is_comparable ? *cell->second.cost : kNone);
    if (is_there && status && cell->second.status != *status)
      found.status_change = fmt::format("{} -> {} at {}", word_of(*status), word_of(cell->second.status), entry.commit);
    if (is_there) status = cell->second.status;
  }
  found.error.changes = changes_of_errors(found.error.values);
  found.cost.changes = changes_of_costs(found.cost.values);
  return found;
}

}  // namespace

double median_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return kNone;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

LevelChange level_change(const CellSeries& series, std::size_t which) {
  const auto at = [&](std::size_t i) { return series.values.begin() + static_cast<std::ptrdiff_t>(i); };
  const std::size_t begin = which == 0 ? 0 : series.changes[which - 1], middle = series.changes[which],
                    end = which + 1 < series.changes.size() ? series.changes[which + 1] : series.values.size();
  return {median_of({at(begin), at(middle)}), median_of({at(middle), at(end)}), middle};
}

std::vector<CellHistory> cell_histories(const std::vector<HistoryEntry>& history,
                                        const std::vector<std::string>& words) {
  std::set<CellKey> keys;
  for (const HistoryEntry& entry : history) {
    for (const auto& [key, cell] : entry.cells) keys.insert(key);
  }
  std::vector<CellHistory> found;
  for (const CellKey& key : keys) {
    const std::string name = key.text(" ");
    const bool is_named = std::any_of(words.begin(), words.end(),
                                      [&](const std::string& word) { return name.find(word) != std::string::npos; });
    if (words.empty() || is_named) found.push_back(history_of(history, key));
  }
  return found;
}

}  // namespace rigor::inline analysis
