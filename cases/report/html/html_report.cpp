// report.html: one file without dependencies. It holds the page's script and style, then the data: results.json, and
// separately the thinned motions, so that a case is unpacked only when it is viewed. All data is JSON in <script>
// elements that no browser runs. results.json is deflated, because it is long and repetitive.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/report/html/data_element.h"
#include "cases/report/html/packed_cells.h"
#include "cases/report/html/page_bundle.h"
#include "cases/report/html/playback.h"
#include "cases/report/json/json_report.h"
#include "cases/report/json/packing.h"
#include "cases/report/reports.h"
#include "cases/results/result_json.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

// Seven digits, more than the page shows anywhere. Non-finite values are not shown. strtod reads them back and handles
// subnormal numbers.
void round_numbers(Json& json) {
  if (json.is_number_float()) {
    const double value = json.get<double>();
    json = std::isfinite(value) ? Json(std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr)) : Json(nullptr);
  } else if (json.is_structured()) {
    for (Json& part : json) round_numbers(part);
  }
}

void erase_nulls(Json& object) {
  for (auto it = object.begin(); it != object.end();) it = it->is_null() ? object.erase(it) : std::next(it);
}

// Removes metrics that do not apply, and what the page does not show of the others. The end of the comparison stays
// where it is not the end of the run. An error's own value is what was found, and 0 what was expected, if nothing else
// is said.
void shorten_metrics(Json& metrics, double duration) {
  Json kept = Json::object();
  for (auto& [name, metric] : metrics.items()) {
    if (metric.contains("not_applicable")) continue;
    metric.erase("first_second"), metric.erase("unit");
    if (auto worst = metric.find("worst"); worst != metric.end() && worst->is_object() && (*worst)["expected"] == 0 &&
                                           (*worst)["found"] == metric["value"])
      worst->erase("found"), worst->erase("expected");
    if (metric.value("compared_until", Json()) == duration) metric.erase("compared_until");
    kept[name] = std::move(metric);
  }
  metrics = std::move(kept);
}

// A row of the page's table has the run, the step and the value of an answer; the text says the rest.
void shorten_gate(Json& gate) {
  for (Json& answer : gate["answers"]) {
    answer.erase("value");
    if (answer["caveat"] == "") answer.erase("caveat");
    if (answer["answer"] != "held" || answer["dt"] == "") continue;
    const std::string text = answer["text"];
    const std::size_t comma = text.find(", ");
    answer["text"] = comma == std::string::npos ? "" : text.substr(comma + 2);
  }
  erase_nulls(gate);
}

void shorten_case(Json& one) {
  one.erase("spread"), one.erase("explanation_claims");
  for (Json& gate : one["gates"]) shorten_gate(gate);
  for (Json& table : one["work_precision"]) table.erase("at_equal_cost");
  Json orders = Json::array();
  for (Json& order : one["observed_order"])
    if (order["value"].is_number()) orders.push_back(std::move(order));
  one["observed_order"] = std::move(orders);
}

// The page draws the mean errors of each trial.
void shorten_trials(Json& trials) {
  for (Json& trial : trials) {
    Json kept = Json::object();
    for (auto& [name, value] : trial["metrics"].items())
      if (name.starts_with("mean_")) kept[name] = value;
    trial["metrics"] = std::move(kept);
    if (trial["status"] == "pass") trial.erase("status");
  }
}

// Of a cell's gates the page counts those that failed; the case's gates say the rest.
void shorten_cell(Json& cell, double duration) {
  cell.erase("trajectory"), cell.erase("wall_seconds");
  shorten_metrics(cell["metrics"], duration);
  if (cell.contains("trials")) shorten_trials(cell["trials"]);
  Json failed = Json::array();
  for (const Json& gate : cell["gates"])
    if (gate["answer"] == "failed") failed.push_back({{"answer", "failed"}});
  cell["gates"] = std::move(failed);
  for (const char* rare : {"reduced_order", "sub_step"})
    if (cell[rare].is_null()) cell.erase(rare);
}

// A step as a number of C: "1/30", pasted as it is, would be an integer division.
std::string step_in_c(std::string dt) {
  const std::size_t slash = dt.find('/');
  return slash == std::string::npos ? dt : dt.replace(slash, 1, ".0 / ");
}

// Of each run and step, the engine's own calls.
Json calls_json(const Results& results) {
  std::set<std::string> steps;
  for (const CaseResult& result : results.cases)
    for (const StepSize& dt : result.definition.dt) steps.insert(dt.text);
  Json calls = Json::object();
  for (const RunName& run : results.runs) {
    for (const std::string& dt : steps)
      if (const std::vector<std::string> lines = engine_calls(run, step_in_c(dt)); !lines.empty())
        calls[run.text][dt] = lines;
  }
  return calls;
}

// results.json without the parts that the page does not show, and with each engine's own calls.
std::string results_data(const Results& results) {
  Json json = results_json(results);
  std::map<std::string, double> durations;
  for (Json& one : json["cases"]) {
    shorten_case(one);
    durations[one["id"].get<std::string>()] = one["duration"].get<double>();
  }
  for (Json& cell : json["cells"]) shorten_cell(cell, durations[cell["case"].get<std::string>()]);
  json["calls"] = calls_json(results);
  auto& stable = json["stable_dt"].get_ref<Json::array_t&>();
  std::erase_if(stable,
                [](const Json& row) { return row["status"] == "unsupported" && row["reason"] == "not asked for"; });
  round_numbers(json);
  pack_cells(json);
  // A browser reads text without accents twice as fast.
  constexpr bool kOnlyAscii = true;
  return base64(deflated(json.dump(-1, ' ', kOnlyAscii, Json::error_handler_t::replace)));
}

// The motions of the trials stand in a list; a case without trials has one motion.
Json motion_json(const Motions& motions) { return motions.size() == 1 ? Json(motions.front()) : Json(motions); }

Json playbacks(const Results& results, std::size_t budget) {
  const PlaybackChoice chosen(results, budget);
  Json cases = Json::array();
  for (const CaseResult& result : results.cases) {
    Json cells = Json::array();
    for (const Cell& cell : result.cells) cells.push_back(motion_json(chosen.of(result, cell)));
    cases.push_back({{"truth", motion_json(chosen.of_truth(result))}, {"cells", cells}});
  }
  return {{"series", series_names()}, {"cases", cases}};
}

// Only one script runs in the page, identified by its hash, whatever names the data contain. Nothing is fetched or
// sent.
std::string policy() {
  return fmt::format(
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src '{}'; style-src "
      "'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n",
      kPageScriptHash);
}

}  // namespace

std::string html_report(const Results& results) {
  std::string page = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n" + policy() +
                     "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                     "<meta name=\"color-scheme\" content=\"light dark\">\n<title>Rigor: which engine, which step, and "
                     "why</title>\n<style>\n";
  page += kPageStyle;
  page +=
      "</style>\n</head>\n<body>\n<main id=\"page\"><p class=\"loading\">Unpacking the results …</p>"
      "<noscript>This report needs JavaScript, which is off here. report.md has the same content as text."
      "</noscript></main>\n";
  page +=
      data_element(kResultsElement, {{"encoding", "base64 of zlib of results.json"}, {"data", results_data(results)}});
  constexpr std::size_t kWholePage = 3'900'000, kLeastPlayback = 250'000;  // characters
  const std::size_t rest = page.size() + kPageScript.size() + kPageLicences.size();
  page += data_element(kPlaybackElement, playbacks(results, std::max(kWholePage, rest + kLeastPlayback) - rest));
  page += "<script>";  // and nothing else in it: it has a hash
  page += kPageScript;
  page += "</script>\n<!--\n";
  page += kPageLicences;
  page += "-->\n</body>\n</html>\n";
  return page;
}

}  // namespace rigor::inline report
