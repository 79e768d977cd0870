// The page of `rigor diverge --out` in a headless Chromium. Screenshots stay in the build tree.
#include <boost/test/unit_test.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "cases/report/html/data_element.h"
#include "cases/report/json/json_report.h"
#include "cases/report/reports.h"
#include "tests/cases/cli/program.h"
#include "tests/cases/report/html/page_in_browser.h"
#include "tests/cases/report/sample_results.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_report_html_divergence_page)

namespace {

using Json = nlohmann::json;

constexpr const char* kHarm = "</script><img src=x onerror=window.harm=1>";

// Runs that leave the bound by less than three times what their repeats differ by; with names that would do harm.
Json within_the_spread(const std::string& case_id) {
  const auto run = [](double spread) {
    return Json{
        {"run", kHarm}, {"dt", "1/30"}, {"settings", Json::object()}, {"deterministic", false}, {"spread", spread}};
  };
  return {{"case", case_id},
          {"a", run(2)},
          {"b", run(0)},
          {"compared", 1},
          {"ended", std::string(kHarm) + " blows up at 1.1 s"},
          {"largest_share", 4},
          {"gap", {{"time", {0, 0.5, 1}}, {"share", {0, 4, 3}}}},
          {"parting", nullptr}};
}

Json same_numbers(const std::string& case_id) {
  Json json = within_the_spread(case_id);
  json["ended"] = "", json["largest_share"] = 0, json["gap"]["share"] = {0, 0, 0};
  return json;
}

// Runs that part and of which nothing more could be measured.
Json unmeasured(const std::string& case_id) {
  Json json = within_the_spread(case_id);
  json["parting"] = {{"time", 0.5},    {"body", kHarm},  {"component", "turn about y"}, {"unit", "rad"}, {"gap", 0.004},
                     {"bound", 0.001}, {"part", -0.004}, {"common_steps", 15}};
  json["truth"] = {{"none", "the case has no truth"}};
  json["injections"] = {{"injected", 0},          {"growth", 0},           {"growth_factor", 1}, {"all_steps", true},
                        {"why", "a run crashed"}, {"steps", Json::array()}};
  json["causes"] = json["swaps"] = json["calls"] = Json::array();
  json["setting"] = nullptr, json["differing_settings"] = false, json["command"] = "";
  return json;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_page_says_where_two_runs_part, *boost::unit_test::timeout(300)) {
  Folder folder;
  folder.write("top.toml",
               tumbling_top(kHarm, "shape = { type = \"box\", size = [0.5, 0.4, 0.3] }\ncollides = false\n"));
  const std::string diverge =
      "cd " + folder.path.string() + " && " + RIGOR_PROGRAM + " diverge top.toml --jobs 2 --out ";
  BOOST_TEST_REQUIRE(succeeds(diverge + "parted --engine ode --engine ode,gyroscopic=off", folder));
  BOOST_TEST_REQUIRE(
      succeeds(diverge + "steps --engine core:semi-implicit-euler --dt 1/100 --dt 1/50 --duration 1", folder));
  BOOST_TEST_REQUIRE(
      succeeds(diverge + "never --engine core:rk4 --engine core:adams --duration 1 --within 1rad", folder));
  const Results grid = sample_results();
  const std::string id = grid.cases.front().definition.id, page = html_report(grid);
  folder.write("spread/report.html", with_data_element(page, kDivergenceElement, within_the_spread(id)));
  folder.write("same/report.html", with_data_element(page, kDivergenceElement, same_numbers(id)));
  folder.write("unmeasured/report.html", with_data_element(page, kDivergenceElement, unmeasured(id)));
  const std::string out = (folder.path / "parted").string();
  BOOST_TEST(opens_well("divergence_page_test.mjs", folder, out + "/report.html", out + "/results.json", "divergence"));
}

BOOST_AUTO_TEST_CASE(the_element_goes_into_a_page_of_results_alone) {
  const std::string page = html_report(sample_results());
  BOOST_TEST(data_of_element(page, kDivergenceElement) == "");
  const Json json = {{"case", "</script>"}};
  const std::string with = with_data_element(page, kDivergenceElement, json);
  BOOST_TEST((Json::parse(data_of_element(with, kDivergenceElement)) == json));
  BOOST_TEST(data_of_element(with, kResultsElement) == data_of_element(page, kResultsElement));
  BOOST_CHECK_THROW(with_data_element("<p>no results</p>", kDivergenceElement, json), std::logic_error);
}

BOOST_AUTO_TEST_SUITE_END()
