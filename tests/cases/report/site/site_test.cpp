// rigor site, by the program itself: its pages, badges and JSON against the results; versions, bad input, hostile
// names.
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_report_site_site {

using Json = nlohmann::json;
namespace fs = std::filesystem;

// One run of the stone, shared by all tests: ODE errs by half a metre, RK4 by nothing.
const Program& ran() {
  static const Program program;
  static const bool is_made = [] {
    program.folder.write("stone.toml", kThrown);
    return program
               .run({"run", "stone.toml", "--engine", "ode", "--engine", "core:rk4", "--engine", "core:velocity-verlet",
                     "--out", "out"})
               .code == 0;
  }();
  BOOST_TEST_REQUIRE(is_made);
  return program;
}

struct Fixture : Program {
  Json results = Json::parse(ran().content("out/results.json"));
  Fixture() { fs::copy(ran().folder.path / "out", folder.path / "out", fs::copy_options::recursive); }

  void write(const std::string& name, const Json& json) const { folder.write(name + "/results.json", json.dump()); }
  // As if another version of ODE had made it, whose error is `factor` times as large.
  Json other_version(const std::string& version, double factor) const {
    Json json = results;
    for (Json& row : json["engines"])
      if (row["name"] == "ode") row["version"] = version;
    for (Json& cell : json["cells"]) {
      if (cell["engine"] != "ode") continue;
      Json& value = cell["metrics"]["position_error"]["value"];
      value = value.get<double>() * factor;
    }
    return json;
  }
  Json data(const std::string& address) const { return Json::parse(content("site/" + address)); }
  void refuses(const std::vector<std::string>& words, const std::string& expected) const {
    std::vector<std::string> call = {"site"};
    call.insert(call.end(), words.begin(), words.end());
    const Answer answer = run(call);
    BOOST_TEST(answer.code == 2, expected);
    BOOST_TEST(answer.err.find(expected) != std::string::npos, answer.err);
  }
  std::vector<fs::path> files(const std::string& end) const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path / "site"))
      if (entry.is_regular_file() && entry.path().extension() == end) found.push_back(entry.path());
    return found;
  }
};

std::string text_of_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace cases_report_site_site

BOOST_FIXTURE_TEST_SUITE(cases_report_site_site, Fixture, *boost::unit_test::enable_if<RIGOR_HTML_REPORT>())

BOOST_AUTO_TEST_CASE(the_site_says_what_the_results_say) {
  const Answer answer = run({"site", "out"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  const Json index = data("api/index.json");
  BOOST_TEST(index.at("headline_dt") == "1/10");
  BOOST_TEST(index.at("engines").size() == 2u);
  BOOST_TEST(index.at("engines")[0].at("engine") == "ode");
  // Semi-implicit Euler is half a metre off.
  const Json& ode = index.at("engines")[0].at("runs")[0].at("all");
  BOOST_TEST(ode.at("compared") == 1);
  BOOST_TEST(ode.at("within") == 0);
  BOOST_TEST(ode.at("median").get<double>() == 0.5, boost::test_tools::tolerance(1e-9));
  for (const Json& row : index.at("engines")[1].at("runs")) {
    BOOST_TEST(row.at("all").at("compared") == 1);
    BOOST_TEST(row.at("all").at("within") == 1);
  }
  BOOST_TEST(content("site/badge/ode.svg").find("0 of 1 within 1 mm at 1/10 s") != std::string::npos);
  BOOST_TEST(content("site/badge/core~3Ark4.svg").find("1 of 1 within 1 mm at 1/10 s") != std::string::npos);
  BOOST_TEST(content("site/badge/core.svg").find("1 of 1") != std::string::npos);
  BOOST_TEST(content("site/index.html").find("<b>500 mm</b><span>0 of 1</span>") != std::string::npos);
  BOOST_TEST(content("site/engines/ode.html").find("One version so far") != std::string::npos);
  BOOST_TEST(content("site/engines/ode.html").find("<dt>solver</dt>") != std::string::npos);
  BOOST_TEST(content("site/metrics/position_error.html").find("500 mm") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(every_page_is_found_from_the_index_and_no_link_is_broken) {
  BOOST_TEST_REQUIRE(run({"site", "out"}).code == 0);
  for (const Json& metric : results.at("metrics"))
    BOOST_TEST(fs::exists(folder.path / "site/metrics" / (metric.at("name").get<std::string>() + ".html")));
  std::size_t links = 0;
  for (const fs::path& page : files(".html")) {
    const std::string text = text_of_file(page);
    for (const char* attribute : {"href=\"", "src=\""}) {
      for (std::size_t at = 0; (at = text.find(attribute, at)) != std::string::npos; ++at) {
        const std::size_t from = at + std::string(attribute).size();
        const std::string link = text.substr(from, text.find_first_of("\"#", from) - from);
        if (link.empty()) continue;
        ++links;
        BOOST_TEST(fs::is_regular_file(page.parent_path() / link), page.string() + " links to " + link);
      }
    }
  }
  BOOST_TEST(links > 100u);
}

BOOST_AUTO_TEST_CASE(a_regression_is_a_step_at_its_version) {
  write("new", other_version("9.9.9", 4));
  const Answer answer = run({"site", "out", "new"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  const std::string page = content("site/engines/ode.html");
  BOOST_TEST(page.find("1 times to the worse and 0 times to the better") != std::string::npos, page);
  BOOST_TEST(page.find("<td class=\"worse\">worse</td><td>0.5 to 2</td><td>9.9.9 (") != std::string::npos, page);
  BOOST_TEST(page.find("fill=\"#b3261e\"") != std::string::npos);  // the mark of a new level
  const Json steps = data("api/engines/ode.json").at("steps");
  BOOST_TEST_REQUIRE(steps.size() == 1u);
  BOOST_TEST(steps[0].at("is_worse") == true);
  BOOST_TEST(data("api/engines/ode.json").at("history").size() == 2u);
  // The newest version is the one that counts, and the core's runs did not change.
  BOOST_TEST(data("api/index.json").at("engines")[0].at("runs")[0].at("all").at("median").get<double>() == 2,
             boost::test_tools::tolerance(1e-9));
  BOOST_TEST(data("api/engines/core.json").at("steps").empty());
  // The other way round it is none.
  BOOST_TEST_REQUIRE(run({"site", "new", "out"}).code == 0);
  BOOST_TEST(content("site/engines/ode.html").find("0 times to the worse and 1 times to the better") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(only_the_newest_version_of_a_run_is_current) {
  Json old = other_version("0.1", 1), more = old;
  // The old version has a case that the new one has not.
  more["cases"].push_back(old["cases"][0]), more["cases"][1]["id"] = "other";
  for (Json cell : old["cells"]) cell["case"] = "other", more["cells"].push_back(cell);
  write("old", more);
  BOOST_TEST_REQUIRE(run({"site", "old", "out"}).code == 0);
  for (const Json& engine : data("api/index.json").at("engines"))
    for (const Json& row : engine.at("runs"))
      BOOST_TEST(row.at("all").at("compared") == (row.at("name") == "ode" ? 1 : 2), row.at("name").dump());
  BOOST_TEST(data("api/cases/other.json").at("cells").size() == 2u);
  BOOST_TEST(data("api/cases/stone.toml.json").at("cells").size() == 3u);
}

BOOST_AUTO_TEST_CASE(a_history_file_is_older_than_the_folders) {
  write("old", other_version("0.1", 0.5));
  setenv("RIGOR_COMMIT", "abc", 1);
  BOOST_TEST(run({"history", "add", "old"}).code == 0);
  BOOST_TEST(run({"history", "add", "out"}).code == 0);
  unsetenv("RIGOR_COMMIT");
  BOOST_TEST_REQUIRE(run({"site", "history.jsonl", "out"}).code == 0);
  const Json ode = data("api/engines/ode.json");
  BOOST_TEST_REQUIRE(ode.at("history").size() == 2u);  // the folder itself is the last line of the history
  BOOST_TEST(ode.at("history")[0].at("version") == "0.1 (abc)");
  BOOST_TEST_REQUIRE(ode.at("steps").size() == 1u);
  BOOST_TEST(ode.at("steps")[0].at("is_worse") == true);
}

BOOST_AUTO_TEST_CASE(one_version_with_two_values_is_refused_and_with_one_value_is_not) {
  Json other = results;
  other["wall_seconds"] = 7;
  write("same", other);
  BOOST_TEST(run({"site", "out", "same"}).code == 0);
  for (Json& cell : other["cells"])
    if (cell["engine"] == "ode") cell["metrics"]["velocity_error"]["value"] = 0.25;
  write("other", other);
  refuses({"out", "other"}, "velocity_error is");
  refuses({"out", "other"}, "leave one folder out");
  for (Json& cell : other["cells"])
    if (cell["engine"] == "ode") cell["status"] = "crashed";
  write("other", other);
  refuses({"out", "other"}, "crashed");
}

BOOST_AUTO_TEST_CASE(cells_of_a_case_that_has_changed_are_left_out) {
  Json old = other_version("0.1", 3);
  old["cases"][0]["file"] = "title = \"another\"";
  write("old", old);
  const Answer answer = run({"site", "old", "out"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  BOOST_TEST(answer.err.find("1 cases have changed since") != std::string::npos, answer.err);
  BOOST_TEST(data("api/engines/ode.json").at("steps").empty());
  BOOST_TEST(data("api/cases/stone.toml.json").at("cells").size() == 3u);
}

BOOST_AUTO_TEST_CASE(errors_that_are_held_to_themselves_are_no_evidence) {
  for (Json& cell : results["cells"])
    for (Json& metric : cell["metrics"]) metric["held_to_itself"] = true;
  write("own", results);
  BOOST_TEST_REQUIRE(run({"site", "own"}).code == 0);
  BOOST_TEST(data("api/index.json").at("engines")[0].at("runs")[0].at("all").at("compared") == 0);
  BOOST_TEST(content("site/badge/ode.svg").find("nothing compared") != std::string::npos);
  BOOST_TEST(content("site/badge/ode.svg").find("#5f6368") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(cells_that_failed_count_as_not_within) {
  for (Json& cell : results["cells"])
    if (cell["engine"] == "core:rk4")
      cell["status"] = "crashed", cell["metrics"] = Json::object(), cell["verdict"] = nullptr;
  write("failed", results);
  BOOST_TEST_REQUIRE(run({"site", "failed"}).code == 0);
  BOOST_TEST(content("site/badge/core~3Ark4.svg").find("0 of 1 within") != std::string::npos);
  BOOST_TEST(content("site/index.html").find("<b>failed</b><span>0 of 1, 1 failed</span>") != std::string::npos);
  // Only failures: there is nothing to compare, and a page says so.
  for (Json& cell : results["cells"])
    cell["status"] = "crashed", cell["metrics"] = Json::object(), cell["verdict"] = nullptr;
  write("failed", results);
  BOOST_TEST_REQUIRE(run({"site", "failed"}).code == 0);
  BOOST_TEST(content("site/badge/ode.svg").find("nothing compared") != std::string::npos);
  BOOST_TEST(content("site/engines/ode.html").find("crashed") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_report_of_another_run_lends_no_motion) {
  const std::string report = content("out/report.html");
  Json other = results;
  other["wall_seconds"] = results["wall_seconds"].get<double>() * 1.01;
  write("out", other);
  const Answer answer = run({"site", "out"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  BOOST_TEST(answer.err.find("belongs to another run") != std::string::npos, answer.err);
  write("out", results);
  std::string page = report;
  const std::size_t truth = page.find("\"truth\":\"");
  BOOST_TEST_REQUIRE(truth != std::string::npos);
  folder.write("out/report.html", page.replace(truth, 9, "\"truth\":7,\"other\":\""));
  BOOST_TEST(run({"site", "out"}).err.find("holds what is no motion") != std::string::npos);
  folder.write("out/report.html",
               "<script type=\"application/json\" id=\"rigor-results\">{\"data\":\"AAAA\"}</script>");
  BOOST_TEST(run({"site", "out"}).err.find("no playback") != std::string::npos);
  fs::remove(folder.path / "out/report.html");
  BOOST_TEST(run({"site", "out"}).err.find("has no report.html") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(input_that_is_no_result_is_refused) {
  refuses({}, "takes the folders");
  refuses({"none"}, "cannot be read");
  folder.write("empty/other.txt", "");
  refuses({"empty"}, "cannot be read");
  folder.write("text/results.json", "no JSON");
  refuses({"text"}, "is not JSON");
  Json json = results;
  json["schema"] = 1;
  write("older", json);
  refuses({"older"}, "its schema is 1; allowed: 2");
  json["schema"] = 3;
  write("newer", json);
  refuses({"newer"}, "its schema is 3");
  json = results, json["cells"] = Json::array();
  write("bare", json);
  refuses({"bare"}, "has no cells");
  for (const char* key : {"engines", "cases", "cells", "program", "metrics", "stable_dt", "machine"}) {
    json = results, json.erase(key);
    write("part", json);
    refuses({"part"}, "results.json");
  }
  json = results, json["cells"][0]["engine"] = "unknown";
  write("part", json);
  refuses({"part"}, "results.json");
  folder.write("history.jsonl", "{}\n");
  refuses({"history.jsonl", "out"}, "line 1");
  BOOST_TEST(!fs::exists(folder.path / "site"));
}

BOOST_AUTO_TEST_CASE(the_folder_is_replaced_as_a_whole_or_not_at_all) {
  BOOST_TEST_REQUIRE(run({"site", "out"}).code == 0);
  folder.write("site/engines/gone.html", "of an older site");
  const std::string before = content("site/index.html");
  // A file of more than 100 blocks cannot be written: page.js is longer.
  const std::string limited =
      "cd '" + folder.path.string() + "' && (ulimit -f 100; '" RIGOR_PROGRAM "' site out >stdout 2>stderr)";
  BOOST_TEST(std::system(limited.c_str()) != 0);
  BOOST_TEST(content("site/index.html") == before);
  BOOST_TEST(fs::exists(folder.path / "site/engines/gone.html"));
  BOOST_TEST_REQUIRE(run({"site", "out"}).code == 0);
  BOOST_TEST(!fs::exists(folder.path / "site/engines/gone.html"));
  BOOST_TEST(!fs::exists(folder.path / ".site.partial"));
  folder.write("site/CNAME", "example.org");
  refuses({"out"}, "'CNAME' in it is not of a site");
  folder.write("file", "");
  refuses({"out", "--out", "file"}, "it is no folder");
  refuses({"out", "--out", "file/below"}, "--out file/below");
  refuses({"out", "--out", ""}, "--out: needs a value");
}

BOOST_AUTO_TEST_CASE(hostile_names_stay_text_and_stay_inside) {
  const std::string harm = "</script><script>window.harm=1</script>\"'&../../../harm";
  std::string text = results.dump();
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
  };
  const std::string quoted = Json(harm).dump();
  replace("\"ode\"", quoted), replace("\"stone.toml\"", quoted);
  Json json = Json::parse(text);
  json["cases"][0]["title"] = harm, json["metrics"][0]["summary"] = harm, json["metrics"][0]["name"] = harm;
  for (Json& cell : json["cells"]) cell["reason"] = harm, cell["settings"][harm] = harm;
  for (Json& row : json["engines"]) row["version"] = harm;
  write("hostile", json);
  const Answer answer = run({"site", "hostile", "--out", "deep/er/site"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  fs::rename(folder.path / "deep/er/site", folder.path / "site");
  for (const auto& entry : fs::recursive_directory_iterator(folder.path / "site")) {
    for (const char c : entry.path().filename().string())
      BOOST_TEST(
          (std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string("._~-").find(c) != std::string::npos));
  }
  for (const fs::path& page : files(".html")) {
    const std::string html = text_of_file(page);
    BOOST_TEST(html.find("<script>") == std::string::npos, page);
    BOOST_TEST(html.find("Content-Security-Policy\" content=\"default-src 'none'") != std::string::npos, page);
    BOOST_TEST(html.find("'unsafe-eval'") == std::string::npos, page);
    const std::size_t scripts = html.find("script-src");
    const bool is_case = page.string().find("/cases/") != std::string::npos;
    BOOST_TEST((scripts != std::string::npos) == is_case, page);
    if (is_case) BOOST_TEST(html.substr(scripts, 18) == "script-src 'self';", page);
  }
  for (const fs::path& badge : files(".svg"))
    BOOST_TEST(text_of_file(badge).find("<script") == std::string::npos, badge);
}

BOOST_AUTO_TEST_CASE(the_pages_work_in_a_browser, *boost::unit_test::timeout(400)) {
  write("old", other_version("0.1", 0.25));
  BOOST_TEST_REQUIRE(run({"site", "old", "out"}).code == 0);
  const std::string command = "RIGOR_PAGE_MODULES=" RIGOR_BUILD_DIR "/page/node_modules node " RIGOR_SOURCE_DIR
                              "/tests/cases/report/site/site_page_test.mjs " +
                              path("site") + " stone.toml " RIGOR_BUILD_DIR "/screenshots/site >" + path("said") +
                              " 2>&1";
  const int status = std::system(command.c_str());
  BOOST_TEST((WIFEXITED(status) && WEXITSTATUS(status) == 0), content("said"));
}

BOOST_AUTO_TEST_SUITE_END()
