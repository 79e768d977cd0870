#include "cases/report/site/engine_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cases/results/baseline.h"

namespace rigor::inline report {
namespace {

// Of this engine alone. Its version stands in the place of the commit.
std::optional<HistoryEntry> entry_of(const HistoryEntry& entry, const std::set<std::string>& runs) {
  HistoryEntry own{entry.commit, entry.date, entry.machine, {}, {}};
  for (const auto& [key, cell] : entry.cells) {
    if (!runs.contains(key.engine)) continue;
    own.cells[key] = cell;
    const auto version = entry.versions.find(key.engine);
    if (version != entry.versions.end()) own.versions = {{key.engine, version->second}};
  }
  if (own.cells.empty()) return {};
  if (!own.versions.empty()) own.commit = fmt::format("{} ({})", own.versions.begin()->second, entry.commit);
  return own;
}

bool is_same(const HistoryEntry& a, const HistoryEntry& b) {
  return a.versions == b.versions && a.cells.size() == b.cells.size() &&
         std::equal(a.cells.begin(), a.cells.end(), b.cells.begin(), [](const auto& one, const auto& other) {
           return one.first == other.first && one.second.status == other.second.status &&
                  one.second.metrics == other.second.metrics;
         });
}

// By how much the worst step of a cell made it worse; below 1 if all steps made it better.
double worst_ratio(const CellHistory& cell) {
  constexpr double kLeast = 1e-15;
  double worst = cell.status_change.empty() ? 0 : 1;
  for (std::size_t which = 0; which < cell.error.changes.size(); ++which) {
    const LevelChange step = level_change(cell.error, which);
    const double ratio = std::max(std::abs(step.after), kLeast) / std::max(std::abs(step.before), kLeast);
    worst = std::max(worst, is_higher_better(cell.metric) ? 1 / ratio : ratio);
  }
  return worst;
}

void add_steps(const CellHistory& cell, const std::vector<HistoryEntry>& entries, std::vector<ErrorStep>& out) {
  for (std::size_t which = 0; which < cell.error.changes.size(); ++which) {
    const LevelChange step = level_change(cell.error, which);
    const bool has_grown = std::abs(step.after) > std::abs(step.before);
    out.push_back({cell.name, cell.metric, step.before, step.after, entries[step.entry].commit,
                   has_grown != is_higher_better(cell.metric)});
  }
}

}  // namespace

EngineHistory history_of_engine(const SiteData& data, const EngineRuns& engine) {
  std::set<std::string> runs;
  for (const std::size_t run : engine.runs) runs.insert(data.results.runs[run].text);
  EngineHistory found;
  for (const HistoryEntry& entry : data.history) {
    const std::optional<HistoryEntry> own = entry_of(entry, runs);
    // A folder whose results were added to the history file too is one entry.
    if (own && (found.entries.empty() || !is_same(found.entries.back(), *own))) found.entries.push_back(*own);
  }
  if (found.entries.size() < 2) return found;
  for (CellHistory& cell : cell_histories(found.entries, {}))
    if (!cell.error.changes.empty() || !cell.status_change.empty()) found.changed.push_back(std::move(cell));
  std::stable_sort(found.changed.begin(), found.changed.end(),
                   [](const CellHistory& a, const CellHistory& b) { return worst_ratio(a) > worst_ratio(b); });
  for (const CellHistory& cell : found.changed) add_steps(cell, found.entries, found.steps);
  return found;
}

}  // namespace rigor::inline report
