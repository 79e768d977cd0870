#include "cases/report/site/site_pages.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "cases/report/html/svg.h"
#include "cases/report/json/machine.h"
#include "cases/report/site/addresses.h"
#include "cases/report/wording/wording.h"
#include "core/base/json.h"

namespace rigor::inline report {

std::string site_head(const std::string& title, const std::string& policy) {
  return fmt::format(
      R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; {}; base-uri 'none'; form-action 'none'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{}</title>
)",
      policy, escaped(title));
}

std::string link_to(const std::string& root, const std::string& address, const std::string& text) {
  return fmt::format("<a href=\"{}{}\">{}</a>", root, address, escaped(text));
}

std::string site_page(const std::string& address, const std::string& title, const std::string& body) {
  const std::string root = back_to_root(address);
  return site_head(title, "style-src 'self'; img-src 'self'") +
         fmt::format(R"(<link rel="stylesheet" href="{0}site.css">
</head>
<body>
<header><nav aria-label="Site"><a class="brand" href="{0}index.html">Rigor</a> <a href="{0}index.html#engines">Engines</a>
<a href="{0}index.html#cases">Cases</a> <a href="{0}index.html#metrics">Metrics</a>
<a href="{0}api/index.json">JSON</a></nav></header>
<main>
{1}</main>
<footer><p>Made by Rigor {2}.</p></footer>
</body>
</html>
)",
                     root, body, escaped(this_machine().program_version));
}

std::string error_text(const Score& score) {
  if (!std::isfinite(score.median)) return "failed";
  if (score.unit != "m or rad") return quantity_text(score.median, score.unit);
  const std::string length = quantity_text(score.median, "m");  // "16 mm", or "16 m"
  const std::size_t space = length.rfind(' ');
  const std::string prefix = length.substr(space + 1, length.size() - space - 2);
  return length + " or " + prefix + "rad";
}

std::string stable_text(const Score& score) {
  if (!score.stable) return "";
  const char* bound = score.stable->is_cap ? "≥ " : score.stable->is_floor ? "< " : "";
  return bound + quantity_text(score.stable->dt, "s");
}

std::string tolerance_text() {
  return quantity_text(kSiteTolerance, "m") + " or " + quantity_text(kSiteTolerance, "rad");
}

std::vector<DeviationRow> deviations_of(const SiteData& data, const EngineRuns& engine) {
  std::set<std::string> runs;
  for (const std::size_t run : engine.runs) runs.insert(data.results.runs[run].text);
  std::vector<DeviationRow> rows;
  for (const Json& one : data.merged.results.at("cases")) {
    for (const Json& gate : one.value("gates", Json::array())) {
      for (const Json& answer : gate.at("answers")) {
        const std::string run = answer.at("engine").get<std::string>();
        if (answer.at("answer") != word_of(GateAnswer::known_deviation) || !runs.contains(run)) continue;
        rows.push_back({one.at("id").get<std::string>(), run, answer.at("dt").get<std::string>(),
                        gate.at("metric").get<std::string>(), answer.value("text", std::string())});
      }
    }
  }
  return rows;
}

std::map<std::string, std::map<std::string, std::size_t>> settings_of(const SiteData& data, std::size_t run) {
  std::map<std::string, std::map<std::string, std::size_t>> found;
  for (const CaseResult& result : data.results.cases) {
    for (const Cell& cell : result.cells) {
      if (cell.run != run) continue;
      for (const auto& [name, value] : cell.settings) ++found[name][value];
    }
  }
  return found;
}

std::vector<Json> parts_by_case(const Json& results) {
  std::map<std::string, std::size_t> places;
  std::vector<Json> cases;
  for (const Json& one : results.at("cases")) {
    places[one.at("id").get<std::string>()] = cases.size();
    Json own = Json::object();
    for (const char* key : {"schema", "program", "machine", "headline_dt", "tolerances", "metrics"})
      if (results.contains(key)) own[key] = results.at(key);
    own["engines"] = own["cells"] = own["stable_dt"] = own["findings"] = Json::array();
    own["cases"] = Json::array({one});
    cases.push_back(std::move(own));
  }
  for (const char* rows : {"cells", "stable_dt"})
    for (const Json& row : results.at(rows)) cases[places.at(row.at("case").get<std::string>())][rows].push_back(row);
  for (Json& own : cases) {
    std::set<std::string> runs;
    for (const Json& cell : own.at("cells")) runs.insert(cell.at("engine").get<std::string>());
    for (const Json& row : results.at("engines")) {
      const std::string run = row.at("name").get<std::string>();
      if (!runs.contains(run)) continue;
      own["engines"].push_back(row);
      if (results.contains("calls") && results.at("calls").contains(run))
        own["calls"][run] = results.at("calls").at(run);
    }
  }
  return cases;
}

}  // namespace rigor::inline report
