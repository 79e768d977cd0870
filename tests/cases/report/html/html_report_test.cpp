// The report that the program itself writes, in a headless Chromium. Screenshots stay in the build tree.
#include <sys/wait.h>

#include <boost/test/unit_test.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "cases/report/html/playback.h"
#include "cases/report/json/json_report.h"
#include "cases/report/json/packing.h"
#include "cases/report/reports.h"
#include "tests/cases/report/html/page_in_browser.h"
#include "tests/cases/report/html/unpacking.h"
#include "tests/cases/report/sample_results.h"
#include "tests/folder.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_report_html_html_report)
namespace fs = std::filesystem;

namespace {

bool is_valid(const std::string& results, const Folder& folder) {
  return succeeds("node " + kHere + "schema_test.mjs " + kModules + " " + RIGOR_SOURCE_DIR +
                      "/cases/report/json/results.schema.json " + results,
                  folder);
}

// The text between the tags of the element with this id.
std::string data_of(const std::string& page, const std::string& id) {
  const std::string opening = "<script type=\"application/json\" id=\"" + id + "\">";
  const std::size_t from = page.find(opening) + opening.size();
  return page.substr(from, page.find("</script>", from) - from);
}

// Incompressible data, as a motion of this many characters and coarser versions of it.
Packings incompressible(std::size_t finest, std::mt19937& random) {
  std::string text;
  while (text.size() < finest)
    text += "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"[random() % 64];
  Packings packings;
  for (std::size_t size = finest; size > 200; size = size * 7 / 10) packings.push_back(text.substr(0, size));
  return packings;
}

// Bodies on a line that fall, drawn as boxes, with a name each that would do harm as markup.
CaseResult crowd(const Results& grid, int bodies, const std::string& id, std::size_t samples = 31) {
  CaseResult result = grid.cases.front();
  result.definition.id = id;
  result.definition.scene.bodies.clear();
  Trajectory run{.dt = 0.1, .samples = {}};
  for (int i = 0; i < bodies; ++i) {
    Body body;
    body.name = "</script><img src=x onerror=window.harm=1> \"'&\xf0\x9f\x8e\xb2 " + std::to_string(i);
    body.position = Vec3(i % 40, 0, i / 40), body.shape = Box{Vec3(0.4, 0.5, 0.6)};
    result.definition.scene.bodies.push_back(body);
  }
  for (int n = 0; n <= 30; ++n) {
    Sample sample{n * 0.1, BodyTable(bodies)};
    for (int i = 0; i < bodies; ++i) {
      sample.bodies.columns().set_body(i, {result.definition.scene.bodies[i].position - Vec3(0, 0.05 * n * n, 0),
                                           Quat(std::cos(n * .1), 0, 0, std::sin(n * .1)), Vec3::Zero(), Vec3::Zero()});
    }
    run.samples.push_back(sample);
  }
  run.samples.resize(samples);
  const JudgedRun judged{result.definition.scene, run, nullptr, 0};
  for (Cell& cell : result.cells) {
    if (cell.status == Status::pass) cell.recordings["playback"] = packed_run(judged, {}, 1, 200000);
  }
  return result;
}

bool says_what_there_is(const Results& grid, const std::string& name) {
  Folder folder;
  const std::string page = folder.write("report.html", html_report(grid));
  return opens_well("odd_results_test.mjs", folder, page, folder.write("results.json", json_report(grid)), name);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_programs_own_report_works_in_a_browser, *boost::unit_test::timeout(540)) {
  Folder folder;
  const std::string out = (folder.path / "out").string();
  const std::string engines =
      " --engine ode --engine ode@stock --engine bullet --engine bullet@stock --engine core:explicit-euler --engine "
      "core:rk4 --engine core:semi-implicit-euler --engine core:velocity-verlet";
  BOOST_TEST_REQUIRE(succeeds(std::string(RIGOR_PROGRAM) +
                                  " run springs/fixed-spring springs/stiff-3 tops/asymmetric-top contact/collision "
                                  "contact/friction-fan joints/pendulum-90 "
                                  "--jobs 2 --out " +
                                  out + engines,
                              folder));
  BOOST_TEST(is_valid(out + "/results.json", folder));
  BOOST_TEST(succeeds("node " + kHere + "recompute_test.mjs " + RIGOR_PROGRAM + " " + out, folder));
  BOOST_TEST(opens_well("page_test.mjs", folder, out + "/report.html", out + "/results.json", "report"));
}

BOOST_AUTO_TEST_CASE(contact_forces_are_drawn_and_plotted) {
  Folder folder;
  const std::string out = (folder.path / "out").string();
  BOOST_TEST_REQUIRE(
      succeeds(std::string(RIGOR_PROGRAM) +
                   " run forces-of-contact/box-at-rest springs/fixed-spring --dt 1/30 --dt 1/240 --engine "
                   "ode --engine bullet --jobs 2 --out " +
                   out,
               folder));
  BOOST_TEST(is_valid(out + "/results.json", folder));
  BOOST_TEST(opens_well("force_page_test.mjs", folder, out + "/report.html", out + "/results.json", "forces"));
}

BOOST_AUTO_TEST_CASE(every_trial_of_a_recording_can_be_played) {
  Folder folder;
  const std::string out = (folder.path / "out").string();
  BOOST_TEST_REQUIRE(
      succeeds(std::string(RIGOR_PROGRAM) +
                   " run reality/synthetic-tosses springs/fixed-spring --dt 1/296 --engine ode --engine bullet "
                   "--jobs 2 --out " +
                   out,
               folder));
  BOOST_TEST(is_valid(out + "/results.json", folder));
  BOOST_TEST(opens_well("trial_page_test.mjs", folder, out + "/report.html", out + "/results.json", "trials"));
}

// A body has more parts than there are bodies.
BOOST_AUTO_TEST_CASE(each_shape_is_drawn_and_each_part_where_it_is) {
  Results grid = sample_results();
  CaseResult shapes = crowd(grid, 6, "shapes/all");
  const std::vector<Vec3> tetrahedron = {{0, 0, 0.3}, {0.3, 0, -0.1}, {-0.2, 0.3, -0.1}, {-0.2, -0.3, -0.1}};
  Compound rack;
  for (int k = 0; k < 8; ++k)
    rack.parts.push_back({Sphere{0.03}, {Vec3(0.1 * k - 0.35, 0, 0.02 * k), Quat::Identity()}});
  const Shape all[] = {
      rack,       Capsule{0.1, 0.3}, Convex{hull_of(tetrahedron)}, Cylinder{0.2, 0.3}, Ellipsoid{{0.1, 0.2, 0.3}},
      Sphere{0.2}};
  for (std::size_t i = 0; i < 6; ++i) shapes.definition.scene.bodies[i].shape = all[i];
  grid.cases.insert(grid.cases.begin(), shapes);
  BOOST_TEST(says_what_there_is(grid, "shapes"));
}

BOOST_AUTO_TEST_CASE(names_that_would_do_harm_and_runs_of_every_ending_are_shown) {
  Folder folder;
  Results grid = sample_results();
  grid.cases.push_back(crowd(grid, 1, "<b>markup</b>/\"quoted\" & \xf0\x9f\x8e\xb2"));
  grid.cases.push_back(crowd(grid, 3, "endings/at its start", 1));
  grid.cases.push_back(crowd(grid, 3, "endings/without a sample", 0));
  BOOST_TEST(grid.cases.back().cells.front().recordings.at("playback").empty());
  grid.cases.push_back(crowd(grid, 1000, "crowd/thousand"));
  grid.cases.back().definition.text = "# </script><script>window.harm = 1</script>\n";
  for (Status status : {Status::fail, Status::known_deviation, Status::unexpected_pass, Status::unsupported,
                        Status::timed_out, Status::invalid}) {
    CaseResult other = grid.cases.front();
    other.definition.id = "endings/" + word_of(status);
    other.cells.front().status = status;
    if (status != Status::fail) other.cells.front().metrics.clear();
    grid.cases.push_back(other);
  }
  grid.cases.back().error = "the truth was not found", grid.cases.back().truth.reset();
  const std::string page = folder.write("report.html", html_report(grid));
  const std::string results = folder.write("results.json", json_report(grid));
  BOOST_TEST(is_valid(results, folder));
  BOOST_TEST(opens_well("bad_input_test.mjs", folder, page, results, "bad-input"));
}

BOOST_AUTO_TEST_CASE(three_hundred_cases_stay_small_and_quick) {
  Folder folder;
  Results grid = sample_results();
  const CaseResult one = grid.cases.front();
  for (int i = 1; i < 300; ++i) {
    grid.cases.push_back(one);
    grid.cases.back().definition.id = "family-" + std::to_string(i % 12) + "/case-" + std::to_string(i);
  }
  const std::string text = html_report(grid);
  BOOST_TEST(text.size() < 4e6);
  const std::string page = folder.write("report.html", text), results = folder.write("results.json", json_report(grid));
  BOOST_TEST(opens_well("bad_input_test.mjs", folder, page, results, "three-hundred"));
}

BOOST_AUTO_TEST_CASE(one_case_alone_is_shown) {
  Folder folder;
  const Results grid = sample_results();
  const std::string page = folder.write("report.html", html_report(grid));
  BOOST_TEST(opens_well("bad_input_test.mjs", folder, page, folder.write("results.json", json_report(grid)), "one"));
}

BOOST_AUTO_TEST_CASE(results_with_one_cell_are_shown) {
  Results grid = sample_results();
  grid.runs.resize(1);
  CaseResult& one = grid.cases.front();
  one.cells.resize(1), one.stable_steps.resize(1), one.definition.dt.resize(1);
  BOOST_TEST(says_what_there_is(grid, "one-cell"));
}

BOOST_AUTO_TEST_CASE(results_with_only_failures_are_shown) {
  Results grid = sample_results();
  for (Cell& cell : grid.cases.front().cells)
    cell.status = Status::crashed, cell.reason = "killed by SIGSEGV", cell.metrics.clear(), cell.scheme = {};
  for (StableStepResult& stable : grid.cases.front().stable_steps) stable = {Status::crashed, "killed by SIGSEGV", {}};
  BOOST_TEST(says_what_there_is(grid, "only-failures"));
}

BOOST_AUTO_TEST_CASE(results_without_trajectories_are_shown) {
  Results grid = sample_results();
  for (Cell& cell : grid.cases.front().cells) cell.recordings.clear(), cell.trajectory.clear();
  BOOST_TEST(says_what_there_is(grid, "without-trajectories"));
}

BOOST_AUTO_TEST_CASE(a_hundred_thousand_cells_are_shown, *boost::unit_test::timeout(300)) {
  Results grid = sample_results();
  const CaseResult one = grid.cases.front();
  const std::size_t runs = 50, cases = 1000;
  for (std::size_t run = grid.runs.size(); run < runs; ++run) {
    grid.runs.push_back(grid.runs[run % 2]);
    grid.runs.back().text += "@" + std::to_string(run);
  }
  grid.cases.clear();
  for (std::size_t i = 0; i < cases; ++i) {
    CaseResult many = one;
    many.definition.id = "family-" + std::to_string(i % 12) + "/case-" + std::to_string(i);
    many.cells.clear(), many.stable_steps.clear();
    for (std::size_t run = 0; run < runs; ++run) {
      for (std::size_t n = 0; n < 2; ++n)
        many.cells.push_back(one.cells[2 * (run % 2) + n]), many.cells.back().run = run;
      many.stable_steps.push_back(one.stable_steps[run % 2]);
    }
    grid.cases.push_back(std::move(many));
  }
  BOOST_TEST(says_what_there_is(grid, "hundred-thousand"));
}

BOOST_AUTO_TEST_CASE(a_case_in_which_nothing_moves_names_no_step) {
  Results grid = sample_results();
  for (CaseResult& result : grid.cases) result.truth->is_still = true;
  BOOST_TEST(says_what_there_is(grid, "still"));
}

// Before schema 2 there was no frontier, recommendation, claim or phrase of a verdict.
BOOST_AUTO_TEST_CASE(results_of_an_older_schema_are_shown) {
  Folder folder;
  const Results grid = sample_results();
  std::string page = html_report(grid);
  const std::string data = data_of(page, "rigor-results");
  auto old = nlohmann::json::parse(inflated(from_base64(nlohmann::json::parse(data).at("data").get<std::string>())));
  old["schema"] = 1;
  for (const char* key : {"frontier", "recommendation", "tolerances", "step_over_cases", "relative_errors", "calls"})
    old.erase(key);
  for (auto& finding : old.at("findings")) finding.erase("claims");
  for (auto& cell : old.at("cells")) {
    for (const char* key : {"gates", "by_scheme", "sub_step", "reduced_order"}) cell.erase(key);
    if (cell.at("verdict").is_object()) cell.at("verdict").erase("phrase");
  }
  for (auto& one : old.at("cases")) {
    for (const char* key : {"step_needed", "main_error", "explanations", "size"}) one.erase(key);
    one.at("truth").erase("provenance");
  }
  const std::string packed = nlohmann::json{{"data", base64(deflated(old.dump()))}}.dump();
  page.replace(page.find(data), data.size(), packed);
  const std::string results = folder.write("results.json", json_report(grid));
  BOOST_TEST(opens_well("odd_results_test.mjs", folder, folder.write("report.html", page), results, "older-schema"));
}

// The row of a metric, as the page packs it; empty if there is none.
nlohmann::json row_of(const nlohmann::json& data, std::size_t cell, const std::string& metric) {
  for (const auto& row : data.at("cells").at(cell).at("metrics"))
    if (data.at("strings").at(row.at(0).get<std::size_t>()) == metric) return row;
  return nlohmann::json::array();
}

// The page shows neither what does not apply nor an order that was not fitted; results.json has both.
BOOST_AUTO_TEST_CASE(the_page_leaves_out_what_it_does_not_show) {
  const Results grid = sample_results();
  const auto packed = nlohmann::json::parse(data_of(html_report(grid), "rigor-results"));
  const auto data = nlohmann::json::parse(inflated(from_base64(packed.at("data").get<std::string>())));
  const nlohmann::json results = results_json(grid);
  BOOST_TEST(results.at("cells").at(0).at("metrics").contains("orientation_error"));
  BOOST_TEST(row_of(data, 0, "position_error").size() > 1);
  BOOST_TEST(row_of(data, 0, "orientation_error").empty());
  BOOST_TEST(!data.at("cases").at(0).contains("explanation_claims"));
  for (const auto& order : data.at("cases").at(0).at("observed_order")) BOOST_TEST(order.at("value").is_number());
}

BOOST_AUTO_TEST_CASE(the_page_keeps_to_its_budget_and_uses_it_however_much_there_is_to_play) {
  std::mt19937 random(5);
  Results grid = sample_results();
  grid.cases.resize(300, grid.cases.front());
  std::size_t finest = 0;
  for (CaseResult& result : grid.cases) {
    for (Cell& cell : result.cells) {
      cell.recordings["playback"] = incompressible(10000 + random() % 20000, random);
      finest += cell.recordings["playback"].front().size();
    }
  }
  BOOST_TEST_REQUIRE(finest > 20e6);
  const std::string page = html_report(grid);
  BOOST_TEST(page.size() < 4e6);
  BOOST_TEST(page.size() > 3.5e6);
  const auto playback = nlohmann::json::parse(data_of(page, "rigor-playback"));
  for (const auto& one : playback.at("cases")) {
    for (const auto& cell : one.at("cells")) BOOST_REQUIRE(!cell.get<std::string>().empty());
  }
}

BOOST_AUTO_TEST_CASE(the_data_in_the_page_is_that_of_results_json) {
  const Results grid = sample_results();
  const std::string page = html_report(grid);
  const auto packed = nlohmann::json::parse(data_of(page, "rigor-results"));
  const auto data = nlohmann::json::parse(inflated(from_base64(packed.at("data").get<std::string>())));
  const nlohmann::json results = results_json(grid);
  BOOST_TEST(data.at("cells").size() == results.at("cells").size());
  const auto& settings = data.at("cell_settings").at(data.at("cells").at(0).at("settings").get<std::size_t>());
  BOOST_TEST((settings == results.at("cells").at(0).at("settings")));
  BOOST_TEST((data.at("findings") == results.at("findings")));
  const nlohmann::json row = row_of(data, 0, "position_error");
  const auto& worst = results.at("cells").at(0).at("metrics").at("position_error").at("worst");
  BOOST_TEST((row.at(2) == worst.at("time")));
  BOOST_TEST((data.at("strings").at(row.at(3).get<std::size_t>()) == worst.at("body")));
  BOOST_TEST((data.at("strings").at(row.at(4).get<std::size_t>()) == worst.at("component")));
  BOOST_TEST((row.size() > 6 ? row.at(5) : row.at(1)) == worst.at("found"));
  BOOST_TEST((row.size() > 6 ? row.at(6) : nlohmann::json(0)) == worst.at("expected"));
  BOOST_TEST(row_of(data, 2, "position_error").at(1).is_null());  // it was infinite
  const auto playback = nlohmann::json::parse(data_of(page, "rigor-playback"));
  BOOST_TEST(playback.at("cases").size() == grid.cases.size());
  BOOST_TEST(playback.at("cases").at(0).at("cells").size() == grid.cases[0].cells.size());
}

BOOST_AUTO_TEST_CASE(nothing_in_the_page_comes_from_elsewhere) {
  const std::string page = html_report(sample_results());
  const std::string outside = page.substr(0, page.find("<script type=\"application/json\""));
  for (const char* word : {" src=", "<link", "@import", "url(http", "url(//"})
    BOOST_TEST(outside.find(word) == std::string::npos, word);
  BOOST_TEST(page.find("<!doctype html>") == 0u);
}

BOOST_AUTO_TEST_SUITE_END()
