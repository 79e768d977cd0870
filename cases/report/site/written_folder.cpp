#include "cases/report/site/written_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "cases/report/html/data_element.h"
#include "cases/report/json/packing.h"
#include "cases/report/site/result_rows.h"
#include "cases/results/input_file.h"
#include "cases/results/result_json.h"
#include "cases/results/results.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/json_words.h"

namespace rigor::inline report {
namespace {

namespace fs = std::filesystem;

constexpr int kSchemaOfSite = 2;
constexpr std::size_t kLargestPage = std::size_t{1} << 28;  // bytes of unpacked results

// The report keeps seven digits of the run's wall time, which two runs do not share. A long results.json leaves out
// cells that nobody asked for.
bool is_same_run(const Json& results, const Json& shown) {
  const double a = number_of(results.at("wall_seconds")), b = number_of(shown.at("wall_seconds"));
  if (std::abs(a - b) > 1e-6 * std::abs(a)) return false;
  std::map<CellKey, std::string> cells;
  for (const Json& cell : shown.at("cells")) cells[cell_key_of(cell)] = word_at(cell, "status");
  return std::all_of(results.at("cells").begin(), results.at("cells").end(), [&](const Json& cell) {
    const auto found = cells.find(cell_key_of(cell));
    return found != cells.end() && found->second == word_at(cell, "status");
  });
}

// One text, or one for each trial (html_report.cpp).
const Json& checked_motion(const Json& motion) {
  const auto is_text = [](const Json& one) { return one.is_string(); };
  if (!is_text(motion) && !(motion.is_array() && std::all_of(motion.begin(), motion.end(), is_text)))
    throw InputError("its playback holds what is no motion");
  return motion;
}

// A motion is found by its place: the cells of a case stand in one order in both parts of the report.
void take_motions_of(const Json& shown, const Json& motions, WrittenFolder& out) {
  const Json& cases = shown.at("cases");
  if (motions.at("cases").size() != cases.size()) throw InputError("its playback has other cases");
  std::map<std::string, std::size_t> places, next;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    places[word_at(cases[i], "id")] = i;
    out.truth_motions[word_at(cases[i], "id")] = checked_motion(motions.at("cases")[i].at("truth"));
  }
  for (const Json& cell : shown.at("cells")) {
    const std::string id = word_at(cell, "case");
    out.motions[cell_key_of(cell)] = checked_motion(motions.at("cases")[places.at(id)].at("cells").at(next[id]++));
  }
  out.series = motions.at("series");
}

// Parts of the grid that nobody asked for.
void leave_out_skipped(Json& shown) {
  const std::string reason = word_of(SkipReason::not_asked_for);
  for (const char* rows : {"cells", "stable_dt"}) {
    Json kept = Json::array();
    for (Json& row : shown.at(rows))
      if (row.value("reason", std::string()) != reason) kept.push_back(std::move(row));
    shown[rows] = std::move(kept);
  }
}

// A long results.json names the first cell with the same settings.
void write_out_settings(Json& results) {
  Json& cells = results.at("cells");
  for (Json& cell : cells) {
    if (!cell.contains("settings_of")) continue;
    cell["settings"] = cells.at(cell.at("settings_of").get<std::size_t>()).at("settings");
    cell.erase("settings_of");
  }
}

// A long results.json of Rigor 1.0 does not say it.
void copy_held_to_itself(const Json& shown, Json& results) {
  std::map<CellKey, const Json*> metrics;
  for (const Json& cell : shown.at("cells")) metrics[cell_key_of(cell)] = &cell.at("metrics");
  for (Json& cell : results.at("cells")) {
    const Json& of_shown = *metrics.at(cell_key_of(cell));
    for (auto& [name, metric] : cell.at("metrics").items())
      if (of_shown.contains(name) && of_shown.at(name).value("held_to_itself", false)) metric["held_to_itself"] = true;
  }
}

void read_report(WrittenFolder& folder, std::vector<std::string>& notes) {
  const fs::path file = fs::path(folder.path) / "report.html";
  std::error_code error;
  if (!fs::exists(file, error)) {
    notes.push_back(fmt::format("{} has no report.html: its cases have no playback", folder.path));
    return;
  }
  try {
    const std::string page = read_input_file(file.string(), "a report.html");
    const Json packed = parse_json(data_of_element(page, kResultsElement));
    Json shown = parse_json(inflated(from_base64(packed.at("data").get<std::string>()), kLargestPage));
    const Json motions = parse_json(data_of_element(page, kPlaybackElement));
    if (!is_same_run(folder.results, shown))
      throw InputError("it belongs to another run than the results.json beside it");
    take_motions_of(shown, motions, folder);
    copy_held_to_itself(shown, folder.results);
    leave_out_skipped(shown);
    folder.shown = std::move(shown);
  } catch (const std::exception& fault) {
    folder.series = Json::array(), folder.motions.clear(), folder.truth_motions.clear();
    notes.push_back(fmt::format("{}: its cases have no playback: {}", file.string(), in_words(fault)));
  }
}

}  // namespace

WrittenFolder read_written_folder(const std::string& path, std::vector<std::string>& notes) {
  WrittenFolder folder;
  folder.path = path;
  const std::string file = (fs::path(path) / "results.json").string();
  const std::string text = read_input_file(file, "a folder that 'rigor run' or 'rigor gate' wrote");
  try {
    folder.results = parse_json(text);
    const int schema = folder.results.at("schema").get<int>();
    if (schema != kSchemaOfSite)
      throw InputError(
          fmt::format("its schema is {}; allowed: {}; run the cases again with this version", schema, kSchemaOfSite));
    folder.made_by = folder.results.at("program").at("version").get<std::string>();
    for (const char* key : {"engines", "cases", "cells", "metrics", "stable_dt"})
      if (!folder.results.at(key).is_array()) throw InputError(fmt::format("'{}' is no list", key));
    write_out_settings(folder.results);
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}", file, in_words(error)));
  }
  folder.entry = history_entry(file, folder.made_by, "");
  read_report(folder, notes);
  leave_out_skipped(folder.results);
  std::set<CellKey> cells;
  for (const Json& cell : folder.results.at("cells")) cells.insert(cell_key_of(cell));
  if (cells.empty()) throw InputError(fmt::format("{}: it has no cells", file));
  std::erase_if(folder.entry.cells, [&](const auto& cell) { return !cells.contains(cell.first); });
  return folder;
}

}  // namespace rigor::inline report
