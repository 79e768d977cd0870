#include "cases/report/site/site.h"

#include <fmt/format.h>

#include <filesystem>

#include "cases/report/html/page_bundle.h"
#include "cases/report/site/addresses.h"
#include "cases/report/site/site_pages.h"
#include "cases/report/wording/findings/findings.h"
#include "cases/results/main_error.h"
#include "cases/results/result_json.h"
#include "cases/results/written_results.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/json_words.h"

namespace rigor::inline report {
namespace {

SiteData read_inputs(const std::vector<std::string>& inputs, std::vector<std::string>& notes) {
  std::vector<WrittenFolder> folders;
  SiteData data;
  for (const std::string& input : inputs) {
    std::error_code error;
    const bool is_results = std::filesystem::path(input).filename() == "results.json";
    if (!is_results && std::filesystem::is_regular_file(input, error)) {
      const std::vector<HistoryEntry> entries = read_history(input);
      data.history.insert(data.history.end(), entries.begin(), entries.end());
    } else {
      const std::filesystem::path given = input, folder = is_results ? given.parent_path() : given;
      folders.push_back(read_written_folder(folder.empty() ? "." : folder.string(), notes));
      folders.back().entry.commit = "Rigor " + folders.back().made_by;
    }
  }
  if (folders.empty()) throw InputError("rigor site: takes at least one folder that 'rigor run' or 'rigor gate' wrote");
  const std::string newest = folders.back().path;
  try {
    data.merged = merged_results(std::move(folders), notes);
    data.results = results_from(data.merged.results);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: is no whole results.json: {}", newest, in_words(error)));
  }
  data.history.insert(data.history.end(), data.merged.history.begin(), data.merged.history.end());
  data.headline = headline_dt(data.results);
  data.engines = engines_of(data.results), data.families = families_of(data.results);
  return data;
}

void add_engines(const SiteData& data, std::vector<SiteFile>& files) {
  for (const EngineRuns& engine : data.engines) {
    const EngineHistory history = history_of_engine(data, engine);
    files.push_back({engine_page_address(engine.engine), engine_page(data, engine, history)});
    files.push_back({engine_data_address(engine.engine), text_of(engine_data(data, engine, history), -1) + "\n"});
    const std::size_t main = main_run(data.results, engine);
    if (data.results.runs[main].text != engine.engine)
      files.push_back({badge_address(engine.engine), badge_of(data, main)});
    for (const std::size_t run : engine.runs)
      files.push_back({badge_address(data.results.runs[run].text), badge_of(data, run)});
  }
}

void add_cases(const SiteData& data, std::vector<SiteFile>& files) {
  const std::vector<Json> parts = parts_by_case(data.merged.results);
  std::vector<Json> shown = parts_by_case(data.merged.shown);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const CaseResult& result = data.results.cases[i];
    shown[i]["cases"][0]["main_error"] = main_error(result);
    files.push_back({case_page_address(result.definition.id), case_page(data, result.definition.id, shown[i])});
    files.push_back({case_data_address(result.definition.id), text_of(case_data(data, parts[i], i), -1) + "\n"});
  }
}

}  // namespace

std::vector<SiteFile> site_files(const std::vector<std::string>& inputs, std::vector<std::string>& notes) try {
  const SiteData data = read_inputs(inputs, notes);
  std::vector<SiteFile> files = {{"index.html", index_page(data)},
                                 {"site.css", std::string(kSiteStyle)},
                                 {"page.css", std::string(kPageStyle)},
                                 {"page.js", std::string(kPageScript)},
                                 {"licences.txt", std::string(kPageLicences)},
                                 {"api/index.json", text_of(index_data(data), -1) + "\n"}};
  add_engines(data, files), add_cases(data, files);
  for (const Json& metric : data.merged.results.at("metrics"))
    files.push_back({metric_page_address(metric.at("name").get<std::string>()), metric_page(data, metric)});
  return files;
} catch (const Json::exception& error) {
  throw InputError(fmt::format("rigor site: a results.json is not whole: {}", in_words(error)));
}

}  // namespace rigor::inline report
