// report.html: one file without dependencies. It holds the page's script and style, then the data: results.json, and
// separately the thinned motions, so that a case is unpacked only when it is viewed. All data is JSON in <script>
// elements that no browser runs. results.json is deflated, because it is long and repetitive.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cases/report/html/packing.h"
#include "cases/report/html/page_bundle.h"
#include "cases/report/html/playback.h"
#include "cases/report/json/json_report.h"
#include "cases/report/reports.h"
#include "cases/results/result_json.h"
#include "core/base/json.h"

namespace rigor {
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

// results.json without the parts that the page does not show.
std::string results_data(const Results& results) {
  Json json = results_json(results);
  for (Json& one : json["cases"]) {
    one.erase("spread");
    for (Json& table : one["work_precision"]) table.erase("at_equal_cost");
  }
  for (Json& cell : json["cells"]) {
    cell.erase("trajectory"), cell.erase("wall_seconds");
    for (Json& metric : cell["metrics"]) metric.erase("first_second"), metric.erase("unit");
  }
  round_numbers(json);
  return base64(deflated(text_of(json, -1)));
}

Json playbacks(const Results& results, std::size_t budget) {
  const PlaybackChoice chosen(results, budget);
  Json cases = Json::array();
  for (const CaseResult& result : results.cases) {
    Json cells = Json::array();
    for (const Cell& cell : result.cells) cells.push_back(chosen.of(result, cell));
    cases.push_back({{"truth", chosen.of_truth(result)}, {"cells", cells}});
  }
  return {{"series", series_names()}, {"cases", cases}};
}

// JSON that may stand in a <script>: no "<" is left that could end it or begin a comment.
std::string inside_script(const Json& json) {
  std::string text = text_of(json, -1), safe;
  for (const char c : text) c == '<' ? safe += "\\u003c" : safe += c;
  return safe;
}

void add_data(std::string& page, const char* id, const Json& json) {
  page += std::string("<script type=\"application/json\" id=\"") + id + "\">" + inside_script(json) + "</script>\n";
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
  std::string page =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n" + policy() +
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>Rigor: which engine, which step, and why</title>\n<style>\n";
  page += kPageStyle;
  page +=
      "</style>\n</head>\n<body>\n<main id=\"page\"><p class=\"loading\">Unpacking the results …</p>"
      "<noscript>This report draws itself with JavaScript, which is off here; report.md says the same in words."
      "</noscript></main>\n";
  add_data(page, "rigor-results", {{"encoding", "base64 of zlib of results.json"}, {"data", results_data(results)}});
  constexpr std::size_t kWholePage = 3'900'000, kLeastPlayback = 1'000'000;  // characters
  const std::size_t rest = page.size() + kPageScript.size() + kPageLicences.size();
  add_data(page, "rigor-playback", playbacks(results, std::max(kWholePage, rest + kLeastPlayback) - rest));
  page += "<script>";  // and nothing else in it: it has a hash
  page += kPageScript;
  page += "</script>\n<!--\n";
  page += kPageLicences;
  page += "-->\n</body>\n</html>\n";
  return page;
}

}  // namespace rigor
