// cases/FAMILY/NAME.html: the report's own page with the data of one case. The script and the style are shared files.
#include <fmt/format.h>

#include "cases/report/html/data_element.h"
#include "cases/report/html/svg.h"
#include "cases/report/json/packing.h"
#include "cases/report/site/addresses.h"
#include "cases/report/site/site_pages.h"
#include "cases/results/result_json.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

Json motions_of(const SiteData& data, const std::string& case_id, const Json& shown) {
  Json cells = Json::array();
  for (const Json& cell : shown.at("cells")) {
    const auto motion =
        data.merged.motions.find({case_id, cell.at("engine").get<std::string>(), cell.at("dt").get<std::string>()});
    cells.push_back(motion == data.merged.motions.end() ? Json("") : motion->second);
  }
  const auto truth = data.merged.truth_motions.find(case_id);
  const Json of_truth = truth == data.merged.truth_motions.end() ? Json("") : truth->second;
  return {{"series", data.merged.series}, {"cases", Json::array({{{"truth", of_truth}, {"cells", cells}}})}};
}

// Where the page leads: the front page, and the cases before and after this one.
Json places_of(const SiteData& data, const std::string& case_id, const std::string& root) {
  Json places = {{"all", root + "index.html"}, {"before", nullptr}, {"after", nullptr}};
  const auto& cases = data.results.cases;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (cases[i].definition.id != case_id) continue;
    const auto place = [&](std::size_t at) -> Json {
      return {{"id", cases[at].definition.id}, {"address", root + case_page_address(cases[at].definition.id)}};
    };
    if (i > 0) places["before"] = place(i - 1);
    if (i + 1 < cases.size()) places["after"] = place(i + 1);
  }
  return places;
}

}  // namespace

std::string case_page(const SiteData& data, const std::string& case_id, const Json& shown) {
  const std::string address = case_page_address(case_id), root = back_to_root(address);
  return site_head("Rigor: " + case_id, "script-src 'self'; style-src 'self' 'unsafe-inline'") +
         fmt::format(
             "<link rel=\"stylesheet\" href=\"{0}page.css\">\n</head>\n<body>\n<main id=\"page\">"
             "<p class=\"loading\">Unpacking the results …</p><noscript>The pictures need JavaScript, which is "
             "off here. <a href=\"{0}{1}\">The same numbers as JSON.</a></noscript></main>\n",
             root, case_data_address(case_id)) +
         data_element(kSiteElement, places_of(data, case_id, root)) +
         data_element(kResultsElement, {{"encoding", "base64 of zlib of the case's part of results.json"},
                                        {"data", base64(deflated(text_of(shown, -1)))}}) +
         data_element(kPlaybackElement, motions_of(data, case_id, shown)) +
         fmt::format("<script src=\"{}page.js\"></script>\n</body>\n</html>\n", root);
}

}  // namespace rigor::inline report
