// The site as JSON: api/index.json, a file for each engine and one for each case.
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "cases/report/json/machine.h"
#include "cases/report/site/addresses.h"
#include "cases/report/site/site_pages.h"
#include "cases/results/main_error.h"
#include "cases/results/result_json.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

constexpr int kSiteSchema = 1;

Json score_json(const Score& score) {
  Json json = {{"compared", score.compared}, {"within", score.within},
               {"failed", score.failed},     {"unsupported", score.unsupported},
               {"median", nullptr},          {"unit", score.unit},
               {"stable_dt", nullptr}};
  if (score.compared > 0) json["median"] = score.median;
  if (score.stable)
    json["stable_dt"] = score.stable->dt, json["stable_dt_is_cap"] = score.stable->is_cap,
    json["stable_dt_is_floor"] = score.stable->is_floor;
  return json;
}

Json run_data(const SiteData& data, std::size_t run) {
  Json json = data.merged.results.at("engines")[run];
  json["badge"] = badge_address(data.results.runs[run].text);
  json["all"] = score_json(score_of(data.results, run, "", data.headline));
  json["families"] = Json::object();
  for (const std::string& family : data.families)
    json["families"][family] = score_json(score_of(data.results, run, family, data.headline));
  return json;
}

// Seven digits: more than an engine's error means.
Json short_number(const Json& value) {
  if (!value.is_number_float()) return value;
  const double number = value.get<double>();
  return std::isfinite(number) ? Json(std::strtod(fmt::format("{:.7g}", number).c_str(), nullptr)) : value;
}

Json cell_data(const Json& cell) {
  Json json = {{"engine", cell.at("engine")},
               {"dt", cell.at("dt")},
               {"dt_seconds", cell.at("dt_seconds")},
               {"status", cell.at("status")}};
  if (cell.at("reason") != "") json["reason"] = cell.at("reason");
  if (!cell.at("verdict").is_null()) json["verdict"] = cell.at("verdict").at("word");
  json["metrics"] = Json::object();
  Json own = Json::array();
  for (const auto& [name, metric] : cell.at("metrics").items()) {
    if (!metric.contains("value")) continue;
    json["metrics"][name] = short_number(metric.at("value"));
    if (metric.value("held_to_itself", false)) own.push_back(name);
  }
  if (!own.empty()) json["held_to_itself"] = own;
  return json;
}

}  // namespace

Json index_data(const SiteData& data) {
  Json json = {{"rigor_site", kSiteSchema},
               {"made_by", this_machine().program_version},
               {"headline_dt", data.headline.text},
               {"tolerance", kSiteTolerance},
               {"engines", Json::array()},
               {"cases", Json::array()},
               {"metrics", data.merged.results.at("metrics")}};
  for (const EngineRuns& engine : data.engines) {
    Json runs = Json::array();
    for (const std::size_t run : engine.runs) runs.push_back(run_data(data, run));
    json["engines"].push_back({{"engine", engine.engine},
                               {"page", engine_page_address(engine.engine)},
                               {"data", engine_data_address(engine.engine)},
                               {"badge", badge_address(engine.engine)},
                               {"runs", runs}});
  }
  for (const CaseResult& result : data.results.cases)
    json["cases"].push_back({{"id", result.definition.id},
                             {"title", result.definition.title},
                             {"page", case_page_address(result.definition.id)},
                             {"data", case_data_address(result.definition.id)}});
  return json;
}

Json engine_data(const SiteData& data, const EngineRuns& engine, const EngineHistory& history) {
  Json json = {{"rigor_site", kSiteSchema},   {"engine", engine.engine}, {"headline_dt", data.headline.text},
               {"tolerance", kSiteTolerance}, {"runs", Json::array()},   {"known_deviations", Json::array()},
               {"history", Json::array()},    {"steps", Json::array()}};
  for (const std::size_t run : engine.runs) {
    Json row = run_data(data, run);
    row["settings"] = settings_of(data, run);
    json["runs"].push_back(row);
  }
  for (const DeviationRow& row : deviations_of(data, engine))
    json["known_deviations"].push_back(
        {{"case", row.case_id}, {"engine", row.run}, {"dt", row.dt}, {"metric", row.metric}, {"text", row.text}});
  for (const HistoryEntry& entry : history.entries)
    json["history"].push_back({{"version", entry.commit}, {"date", entry.date}, {"cells", entry.cells.size()}});
  for (const ErrorStep& step : history.steps)
    json["steps"].push_back({{"cell", step.cell},
                             {"metric", step.metric},
                             {"before", step.before},
                             {"after", step.after},
                             {"at", step.at},
                             {"is_worse", step.is_worse}});
  return json;
}

Json case_data(const SiteData& data, const Json& of_results, std::size_t of_case) {
  const Case& definition = data.results.cases[of_case].definition;
  Json json = {{"rigor_site", kSiteSchema},
               {"page", case_page_address(definition.id)},
               {"main_error", main_error(data.results.cases[of_case])}};
  const Json& one = of_results.at("cases")[0];
  for (const char* key : {"id", "title", "source", "file", "duration", "dt", "truth", "error", "explanations"})
    if (one.contains(key)) json[key] = one.at(key);
  json["cells"] = Json::array();
  for (const Json& cell : of_results.at("cells")) json["cells"].push_back(cell_data(cell));
  json["stable_dt"] = Json::array();
  for (const Json& row : of_results.at("stable_dt")) {
    Json kept = row;
    kept.erase("case");
    json["stable_dt"].push_back(kept);
  }
  return json;
}

}  // namespace rigor::inline report
