// rigor diverge, by the program itself: its lines, its JSON and its exit codes.
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_diverge {

using Json = nlohmann::json;

struct Fixture : Program {
  Fixture() { folder.write("top.toml", tumbling_top("top")), folder.write("cube.toml", kSprungCube); }
  Answer diverge(std::vector<std::string> words) const {
    words.insert(words.begin(), "diverge");
    return run(words);
  }
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace cases_cli_diverge

BOOST_FIXTURE_TEST_SUITE(cases_cli_diverge, Fixture)

BOOST_AUTO_TEST_CASE(the_lines_name_body_cause_truth_and_setting_with_its_calls) {
  const Answer answer = diverge({"top.toml", "--engine", "ode", "--engine", "ode,gyroscopic=off"});
  BOOST_TEST(answer.code == 0, answer.err);
  BOOST_TEST(has(answer.out, "s: 'top' is "), answer.out);
  BOOST_TEST(has(answer.out, "the gyroscopic term of 'top'"), answer.out);
  BOOST_TEST(has(answer.out, "is nearer"), answer.out);
  BOOST_TEST(has(answer.out, "gyroscopic: off -> on"), answer.out);
  BOOST_TEST(has(answer.out, "rigor run top.toml --engine ode"), answer.out);
  BOOST_TEST(has(answer.out, "dWorldStep"), answer.out);
}

BOOST_AUTO_TEST_CASE(json_has_the_same) {
  const Answer answer = diverge({"top.toml", "--engine", "ode", "--engine", "ode,gyroscopic=off", "--json"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  const Json json = Json::parse(answer.out);
  BOOST_TEST(json.at("parting").at("body") == "top");
  BOOST_TEST(json.at("setting").at("closes") == 1.0);
  BOOST_TEST(json.at("causes")[0].at("part") == "the gyroscopic term of 'top'");
  BOOST_TEST(json.at("truth").at("a").get<double>() < json.at("truth").at("b").get<double>());
}

BOOST_AUTO_TEST_CASE(two_steps_part_by_the_order_of_the_scheme_alone) {
  const Answer answer =
      diverge({"cube.toml", "--engine", "core:semi-implicit-euler", "--dt", "1/100", "--dt", "1/200"});
  BOOST_TEST(answer.code == 0, answer.err);
  BOOST_TEST(has(answer.out, "it falls with dt"), answer.out);
  BOOST_TEST(!has(answer.out, "does not fall"), answer.out);
}

BOOST_AUTO_TEST_CASE(runs_within_the_bound_never_part) {
  const Answer answer = diverge({"cube.toml", "--engine", "core:rk4", "--engine", "core:adams", "--within", "1m"});
  BOOST_TEST(answer.code == 0, answer.err);
  BOOST_TEST(has(answer.out, "never in 5 s"), answer.out);
}

BOOST_AUTO_TEST_CASE(out_writes_the_reports_and_what_json_prints) {
  const std::vector<std::string> runs = {"top.toml", "--engine", "ode", "--engine", "ode,gyroscopic=off"};
  std::vector<std::string> words = runs;
  words.insert(words.end(), {"--json", "--out", "parted"});
  const Answer answer = diverge(words);
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  words = runs, words.emplace_back("--json");
  BOOST_TEST(answer.out == diverge(words).out);
  BOOST_TEST(content("parted/divergence.json") == answer.out);
  const Json json = Json::parse(answer.out), results = Json::parse(content("parted/results.json"));
  BOOST_TEST(results.at("cells").size() == 2u);
  for (const auto& cell : results.at("cells")) BOOST_TEST(cell.at("status") == "pass");
  for (const char* file : {"parted/report.md", "parted/junit.xml"}) BOOST_TEST(!content(file).empty(), file);
  BOOST_TEST(!std::filesystem::exists(folder.path / "parted/.rigor-partial"));
  BOOST_TEST(std::filesystem::exists(folder.path / "parted/report.html") == bool(RIGOR_HTML_REPORT));
#if RIGOR_HTML_REPORT
  const std::string page = content("parted/report.html"), tag = "id=\"rigor-divergence\">";
  const std::size_t from = page.find(tag) + tag.size();
  BOOST_TEST((Json::parse(page.substr(from, page.find("</script>", from) - from)) == json));
#endif
}

BOOST_AUTO_TEST_CASE(the_gap_over_time_reaches_the_bound_when_the_runs_part_and_not_before) {
  for (const std::vector<std::string>& runs :
       std::vector<std::vector<std::string>>{{"top.toml", "--engine", "ode", "--engine", "ode,gyroscopic=off"},
                                             {"cube.toml", "--engine", "core:semi-implicit-euler", "--dt", "1/100",
                                              "--dt", "1/200", "--within", "3mm"}}) {
    std::vector<std::string> words = runs;
    words.emplace_back("--json");
    const Json json = Json::parse(diverge(words).out);
    const double parts = json.at("parting").at("time");
    const std::vector<double> time = json.at("gap").at("time"), share = json.at("gap").at("share");
    BOOST_TEST_REQUIRE(time.size() == share.size());
    double before = 0, then = 0, largest = 0;
    for (std::size_t n = 0; n < time.size(); ++n) {
      largest = std::max(largest, share[n]);
      if (time[n] < parts) before = std::max(before, share[n]);
      if (time[n] == parts) then = share[n];
    }
    BOOST_TEST(before > 0.0);
    BOOST_TEST(before <= 1.0);
    BOOST_TEST(then > 1.0);
    BOOST_TEST(then == json.at("parting").at("gap").get<double>() / json.at("parting").at("bound").get<double>(),
               boost::test_tools::tolerance(1e-12));
    BOOST_TEST(largest == json.at("largest_share").get<double>());
  }
}

// Before any work: nothing is printed.
BOOST_AUTO_TEST_CASE(a_folder_that_cannot_be_written_is_refused_at_once) {
  folder.write("file", "");
  std::filesystem::create_directories(folder.path / "taken/divergence.json");
  for (const char* out : {"file", "file/below", "taken"}) {
    const Answer answer = diverge({"top.toml", "--engine", "ode", "--engine", "bullet", "--out", out});
    BOOST_TEST(answer.code == 2, out);
    BOOST_TEST(has(answer.err, "cannot be written"), answer.err);
    BOOST_TEST(answer.out == "");
  }
}

BOOST_AUTO_TEST_CASE(refused_runs_leave_no_output) {
  const Answer answer =
      diverge({"top.toml", "--engine", "ode", "--dt", "1", "--dt", "0.7", "--duration", "2", "--out", "parted"});
  BOOST_TEST(answer.code == 2, answer.err);
  BOOST_TEST((!std::filesystem::exists(folder.path / "parted") || std::filesystem::is_empty(folder.path / "parted")));
}

// Otherwise what was found would stand beside the results of other runs.
BOOST_AUTO_TEST_CASE(a_later_run_in_the_folder_takes_the_divergence_away) {
  BOOST_TEST(diverge({"cube.toml", "--engine", "core:rk4", "--engine", "core:adams", "--out", "out"}).code == 0);
  BOOST_TEST(std::filesystem::exists(folder.path / "out/divergence.json"));
  BOOST_TEST(run({"run", "cube.toml", "--engine", "core:rk4", "--dt", "1/30", "--out", "out"}).code == 0);
  BOOST_TEST(!std::filesystem::exists(folder.path / "out/divergence.json"));
}

BOOST_AUTO_TEST_CASE(bad_input_is_refused) {
  struct Row {
    std::vector<std::string> words;
    std::string expected;
  };
  const std::vector<Row> rows = {
      {{"--engine", "ode"}, "both runs are ode"},
      {{}, "takes two --engine"},
      {{"--engine", "ode", "--engine", "bullet", "--engine", "core"}, "takes two --engine"},
      {{"--engine", "ode", "--engine", "bullet", "--within", "1"}, "no unit"},
      {{"--engine", "ode", "--engine", "bulet"}, "did you mean 'bullet'"},
      {{"--engine", "ode", "--dt", "1/10", "--dt", "1/20", "--dt", "1/30"}, "at most two --dt"},
      {{"--engine", "ode", "--dt", "1", "--dt", "0.7", "--duration", "2"}, "never end together"}};
  for (const Row& row : rows) {
    std::vector<std::string> words = {"top.toml"};
    words.insert(words.end(), row.words.begin(), row.words.end());
    const Answer answer = diverge(words);
    BOOST_TEST(answer.code == 2, row.expected << answer.out);
    BOOST_TEST(has(answer.err, row.expected), answer.err);
    BOOST_TEST(answer.out == "");
  }
}

BOOST_AUTO_TEST_SUITE_END()
