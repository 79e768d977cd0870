#include "cases/report/site/merged_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cases/report/site/result_rows.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

using Names = std::set<std::string>;

template <typename F>
void remove_rows(Json& rows, F is_gone) {
  Json kept = Json::array();
  for (Json& row : rows)
    if (!is_gone(row)) kept.push_back(std::move(row));
  rows = std::move(kept);
}

Json* row_named(Json& rows, const char* key, const Json& name) {
  for (Json& row : rows)
    if (row.at(key) == name) return &row;
  return nullptr;
}

// Cases whose file is not what it was: their older cells are of another problem.
Names changed_cases(const Json& base, const Json& next) {
  std::map<std::string, const Json*> known;
  for (const Json& one : base.at("cases")) known[word_at(one, "id")] = &one;
  Names changed;
  for (const Json& one : next.at("cases")) {
    const auto old = known.find(word_at(one, "id"));
    if (old == known.end()) continue;
    for (const char* key : {"file", "duration"})
      if (old->second->value(key, Json()) != one.value(key, Json())) changed.insert(old->first);
  }
  return changed;
}

// Runs of which the base has another version.
Names replaced_runs(const Json& base, const Json& next) {
  Names replaced;
  for (const Json& row : next.at("engines")) {
    for (const Json& old : base.at("engines")) {
      if (old.at("name") != row.at("name")) continue;
      for (const char* key : {"version", "made_by"})
        if (old.value(key, Json()) != row.value(key, Json())) replaced.insert(word_at(row, "name"));
    }
  }
  return replaced;
}

// Rows about single runs of a case that the newer folder does not have.
void keep_rows_of_runs(Json& old, Json& fresh, const Names& runs) {
  for (const char* key : {"step_needed", "observed_order"}) {
    if (!old.contains(key) || !fresh.contains(key)) continue;
    for (Json& row : old[key])
      if (!runs.contains(word_at(row, "engine"))) fresh[key].push_back(std::move(row));
  }
  for (Json& step : old["dt"])
    if (!row_named(fresh["dt"], "text", step.at("text"))) fresh["dt"].push_back(std::move(step));
}

void append(Json& base, Json&& next, const Names& changed) {
  Names runs;
  for (Json& row : next["engines"]) {
    runs.insert(word_at(row, "name"));
    Json* old = row_named(base["engines"], "name", row.at("name"));
    old ? void(*old = std::move(row)) : base["engines"].push_back(std::move(row));
  }
  for (Json& one : next["cases"]) {
    Json* old = row_named(base["cases"], "id", one.at("id"));
    if (old && !changed.contains(word_at(one, "id"))) keep_rows_of_runs(*old, one, runs);
    old ? void(*old = std::move(one)) : base["cases"].push_back(std::move(one));
  }
  std::set<CellKey> cells;
  std::set<RunKey> searches;
  for (const Json& cell : next["cells"]) cells.insert(cell_key_of(cell));
  for (const Json& row : next["stable_dt"]) searches.insert({word_at(row, "case"), word_at(row, "engine")});
  remove_rows(base["cells"], [&](const Json& cell) { return cells.contains(cell_key_of(cell)); });
  remove_rows(base["stable_dt"], [&](const Json& row) {
    return searches.contains({word_at(row, "case"), word_at(row, "engine")});
  });
  for (const char* rows : {"cells", "stable_dt"})
    for (Json& row : next[rows]) base[rows].push_back(std::move(row));
  if (next.contains("calls"))
    for (auto& [run, calls] : next["calls"].items()) base["calls"][run] = std::move(calls);
  if (next.contains("frontier"))  // says which runs are references
    for (Json& scope : next["frontier"]) base["frontier"].push_back(std::move(scope));
  for (const char* key : {"metrics", "tolerances", "program", "machine", "headline_dt"})
    if (next.contains(key)) base[key] = std::move(next[key]);
}

void merge(Json& base, Json&& next) {
  if (base.is_null()) return void(base = std::move(next));
  const Names changed = changed_cases(base, next), replaced = replaced_runs(base, next);
  const auto is_gone = [&](const Json& row) {
    return changed.contains(word_at(row, "case")) || replaced.contains(word_at(row, "engine"));
  };
  remove_rows(base["cells"], is_gone), remove_rows(base["stable_dt"], is_gone);
  for (Json& one : base["cases"])
    for (const char* key : {"step_needed", "observed_order"})
      if (one.contains(key))
        remove_rows(one[key], [&](const Json& row) { return replaced.contains(word_at(row, "engine")); });
  append(base, std::move(next), changed);
  // What no cell is left of.
  Names cases, runs;
  for (const Json& cell : base["cells"]) cases.insert(word_at(cell, "case")), runs.insert(word_at(cell, "engine"));
  remove_rows(base["cases"], [&](const Json& one) { return !cases.contains(word_at(one, "id")); });
  remove_rows(base["engines"], [&](const Json& row) { return !runs.contains(word_at(row, "name")); });
  remove_rows(base["stable_dt"], [&](const Json& row) {
    return !cases.contains(word_at(row, "case")) || !runs.contains(word_at(row, "engine"));
  });
}

std::string value_text(const HistoryEntry::Cell& cell, const std::string& metric) {
  const auto found = cell.metrics.find(metric);
  return found == cell.metrics.end() ? "none" : fmt::format("{:g}", found->second);
}

// An error repeats bit for bit. A history keeps four digits of it.
void check_repeats(const WrittenFolder& old, const WrittenFolder& fresh, const Names& changed) {
  for (const auto& [key, cell] : fresh.entry.cells) {
    const auto before = old.entry.cells.find(key);
    if (before == old.entry.cells.end() || changed.contains(key.case_id)) continue;
    const auto version = [&](const WrittenFolder& folder) {
      const auto found = folder.entry.versions.find(key.engine);
      return found == folder.entry.versions.end() ? std::string() : found->second;
    };
    if (old.made_by != fresh.made_by || version(old) != version(fresh)) continue;
    std::string metric, was = word_of(before->second.status), is = word_of(cell.status);
    for (const auto& [name, value] : cell.metrics) {
      const auto found = before->second.metrics.find(name);
      if (was == is && found != before->second.metrics.end() && found->second != value) {
        metric = " " + name, was = value_text(before->second, name), is = value_text(cell, name);
        break;
      }
    }
    if (was == is) continue;
    throw InputError(fmt::format(
        "{} and {} hold one cell of one version with different values: {}{} is {} and {}; leave one folder out",
        old.path, fresh.path, key.text(), metric, was, is));
  }
}

// The run's rows say which Rigor made them.
void mark_maker(Json& results, const std::string& made_by) {
  for (Json& row : results["engines"]) row["made_by"] = made_by;
}

// A newer cell without a motion has none: that of an older cell is of another version.
void forget_older_motions(const WrittenFolder& folder, MergedResults& out) {
  for (const Json& cell : folder.results.at("cells")) out.motions.erase(cell_key_of(cell));
  for (const Json& one : folder.results.at("cases")) out.truth_motions.erase(word_at(one, "id"));
}

void take_motions(WrittenFolder& folder, MergedResults& out, std::vector<std::string>& notes) {
  forget_older_motions(folder, out);
  if (folder.series.empty()) return;
  if (!out.series.empty() && out.series != folder.series) {
    notes.push_back(fmt::format("{}: other metrics: only the newest folder's cases have a playback", folder.path));
    out.motions.clear(), out.truth_motions.clear();
  }
  out.series = folder.series;
  for (auto& [key, motion] : folder.motions) out.motions[key] = std::move(motion);
  for (auto& [id, motion] : folder.truth_motions) out.truth_motions[id] = std::move(motion);
}

}  // namespace

MergedResults merged_results(std::vector<WrittenFolder> folders, std::vector<std::string>& notes) {
  MergedResults out;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    WrittenFolder& folder = folders[i];
    for (std::size_t k = 0; k < i; ++k) {
      const Names changed = changed_cases(folders[k].results, folder.results);
      check_repeats(folders[k], folder, changed);
      std::erase_if(out.history[k].cells, [&](const auto& cell) { return changed.contains(cell.first.case_id); });
      if (!changed.empty())
        notes.push_back(fmt::format("{}: {} cases have changed since and are left out, {} among them", folders[k].path,
                                    changed.size(), *changed.begin()));
    }
    mark_maker(folder.results, folder.made_by);
    if (folder.shown.is_null()) folder.shown = folder.results;
    mark_maker(folder.shown, folder.made_by);
    take_motions(folder, out, notes);
    out.history.push_back(folder.entry);
    Json results = folder.results;  // a later folder compares its cases with these
    merge(out.results, std::move(results));
    merge(out.shown, std::move(folder.shown));
  }
  return out;
}

}  // namespace rigor::inline report
