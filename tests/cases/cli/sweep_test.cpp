// rigor sweep, by the program itself: its table against what is known, what it refuses, and that it goes on.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_sweep {

using Json = nlohmann::json;

struct Fixture : Program {
  Fixture() { folder.write("suite/springs/spring.toml", kSprungCube); }
  Answer sweep(std::vector<std::string> words, const std::string& out = "out") const {
    words.insert(words.begin(), {"sweep", "spring"});
    words.insert(words.end(), {"--suite", "suite", "--jobs", "2", "--out", out});
    return run(words);
  }
  std::vector<Json> rows(const std::string& out = "out") const {
    std::vector<Json> found;
    std::istringstream stream(content(out + "/sweep.jsonl"));
    for (std::string line; std::getline(stream, line);) found.push_back(Json::parse(line));
    return found;
  }
};

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace cases_cli_sweep

BOOST_FIXTURE_TEST_SUITE(cases_cli_sweep, Fixture)

// w = sqrt(k/m). Semi-implicit Euler is stable while w dt < 2. It conserves a modified energy; the energy itself may
// rise by 1/(1 - (w dt/2)²). At 1.9 this is 10 times, which counts as blown up, and at 1.7 it is 3.6 times. At 2.05 a
// step multiplies it by 1.56, 60,000 times in the fewest possible steps.
BOOST_AUTO_TEST_CASE(the_boundary_of_stability_is_where_theory_puts_it) {
  const Answer answer = sweep({"--vary", "dt=1/100..1/5:log:12", "--vary", "scene.spring[0].stiffness=1e2..1e6:log:13",
                               "--engine", "core:semi-implicit-euler", "--engine", "ode", "--engine", "bullet"});
  BOOST_TEST(answer.code == 0, answer.err);
  const auto found = rows();
  BOOST_TEST(found.size() == 3u * 12 * 13);
  int stable = 0, blown_up = 0;
  for (const Json& row : found) {
    const double w = std::sqrt(row.at("scene.spring[0].stiffness").get<double>() / 100), dt = row.at("dt");
    std::string expected;
    if (w * dt < 1.7) ++stable, expected = "pass";
    if (w * dt > 2.05) ++blown_up, expected = "diverged";
    BOOST_TEST((expected.empty() || row.at("status") == expected), row.dump());
  }
  BOOST_TEST(stable > 200);
  BOOST_TEST(blown_up > 50);
  const std::string page = content("out/sweep.html");
  BOOST_TEST(page.find("blown up") != std::string::npos);
  BOOST_TEST(page.find("prefers-color-scheme: dark") != std::string::npos);
  // The line ω dt = 2 runs between neighbours on either side of it, in two drawings of each of three runs.
  std::map<std::pair<double, double>, bool> is_beyond;  // stiffness, dt
  std::set<double> stiffnesses, steps;
  for (const Json& row : found) {
    const double k = row.at("scene.spring[0].stiffness"), dt = row.at("dt");
    stiffnesses.insert(k), steps.insert(dt), is_beyond[{k, dt}] = std::sqrt(k / 100) * dt >= 2;
  }
  std::size_t edges = 0;
  for (const auto& [at, beyond] : is_beyond) {
    const auto k = stiffnesses.upper_bound(at.first), dt = steps.upper_bound(at.second);
    edges += k != stiffnesses.end() && is_beyond.at({*k, at.second}) != beyond;
    edges += dt != steps.end() && is_beyond.at({at.first, *dt}) != beyond;
  }
  BOOST_TEST(edges > 10u);
  BOOST_TEST(occurrences(page, "class=\"limit\"") == 3 * 2 * edges);
  BOOST_TEST(occurrences(page, "ω dt = 2 of the stiffest spring") == 1u);
}

// w = 10 rad/s, so w dt = 2 at 0.2 s, between the steps 0.1 and 0.4 s.
BOOST_AUTO_TEST_CASE(the_limit_of_a_spring_is_drawn_only_where_steps_lie_on_both_sides) {
  BOOST_TEST(sweep({"--vary", "dt=1/40,1/10,2/5", "--vary", "scene.spring[0].stiffness=1e4", "--engine",
                    "core:semi-implicit-euler"})
                 .code == 0);
  BOOST_TEST(occurrences(content("out/sweep.html"), "class=\"limit\"") == 2u);  // a map of one row, drawn twice
  BOOST_TEST(sweep({"--vary", "dt=1/40,1/10,2/5", "--engine", "core:semi-implicit-euler"}, "line").code == 0);
  BOOST_TEST(occurrences(content("line/sweep.html"), "class=\"limit\"") == 1u);
  BOOST_TEST(sweep({"--vary", "dt=1/40,1/30", "--engine", "core:semi-implicit-euler"}, "below").code == 0);
  BOOST_TEST(occurrences(content("below/sweep.html"), "class=\"limit\"") == 0u);
}

BOOST_AUTO_TEST_CASE(a_row_is_what_run_says_of_the_cell) {
  BOOST_TEST(sweep({"--vary", "scene.body.cube.mass=100,200", "--engine", "core:rk4", "--engine", "ode"}).code == 0);
  const auto found = rows();
  BOOST_TEST_REQUIRE(found.size() == 8u);
  BOOST_TEST(
      run({"run", "spring", "--engine", "core:rk4", "--engine", "ode", "--suite", "suite", "--out", "whole"}).code ==
      0);
  int compared = 0;
  const Json results = Json::parse(content("whole/results.json"));
  for (const Json& cell : results.at("cells")) {
    for (const Json& row : found) {
      const bool is_it = row.at("engine") == cell.at("engine") && row.at("dt") == cell.at("dt_seconds") &&
                         row.at("scene.body.cube.mass") == 100;
      if (!is_it) continue;
      ++compared;
      BOOST_TEST(row.at("position_error") == cell.at("metrics").at("position_error").at("value"));
    }
  }
  BOOST_TEST(compared == 4);
  const std::string csv = content("out/sweep.csv");
  BOOST_TEST(csv.starts_with("case,engine,dt [s],scene.body.cube.mass [kg],status,verdict,"), csv.substr(0, 100));
  BOOST_TEST(csv.find(",position_error [m],") != std::string::npos);
  BOOST_TEST(std::count(csv.begin(), csv.end(), '\n') == 9);
}

BOOST_AUTO_TEST_CASE(an_option_that_a_method_does_not_have_is_unsupported_there) {
  const Answer answer = sweep({"--vary", "iterations=10..40:log:3", "--engine", "ode:quickstep", "--engine", "core:rk4",
                               "--dt", "1/100", "--metric", "position_error", "--metric", "cost"});
  BOOST_TEST(answer.code == 0, answer.err);
  int unsupported = 0;
  for (const Json& row : rows()) {
    const bool is_ode = row.at("engine") == "ode:quickstep";
    BOOST_TEST(row.at("status") == (is_ode ? "pass" : "unsupported"));
    if (is_ode) BOOST_TEST(row.at("cost").get<double>() > 0);
    unsupported += !is_ode;
    BOOST_TEST(!row.contains("energy_drift"));
  }
  BOOST_TEST(unsupported == 3);
  BOOST_TEST(answer.out.find("unsupported, the first: ") != std::string::npos, answer.out);
}

BOOST_AUTO_TEST_CASE(a_sample_follows_from_its_seed_however_many_jobs_there_are) {
  const std::vector<std::string> words = {"--vary",   "dt=1/1000..1/20:log",
                                          "--vary",   "scene.spring[0].stiffness=1e3..1e5:log",
                                          "--vary",   "scene.body.cube.mass=50..200",
                                          "--engine", "ode",
                                          "--sample", "20"};
  BOOST_TEST(sweep(words, "one").code == 0);
  auto other = words;
  other.insert(other.end(), {"--seed", "2"});
  BOOST_TEST(sweep(other, "two").code == 0);
  BOOST_TEST(sweep(words, "again").code == 0);
  BOOST_TEST(rows("one").size() == 20u);
  BOOST_TEST(content("one/sweep.csv") == content("again/sweep.csv"));
  BOOST_TEST(content("one/sweep.html") == content("again/sweep.html"));
  BOOST_TEST(content("one/sweep.csv") != content("two/sweep.csv"));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_swept_is_refused_and_nothing_is_written) {
  struct Row {
    std::vector<std::string> words;
    std::string expected;
  };
  const std::vector<Row> rows = {
      {{}, "--vary KEY=VALUES"},
      {{"--vary", "scene.sprin[0].stiffness=1,2"}, "did you mean 'spring'"},
      {{"--vary", "scene.spring[0].stifness=1,2"}, "did you mean 'stiffness'"},
      {{"--vary", "scene.body.cub.mass=1,2"}, "did you mean 'cube'"},
      {{"--vary", "scene.body.cube.mass=-1,2"}, "scene.body.cube.mass=-1"},
      {{"--vary", "scene.body.cube.mass=1,0"}, "scene.body.cube.mass=0"},
      {{"--vary", "dt=1/10..1/100:log:5"}, "wrong way round"},
      {{"--vary", "dt=1/100..10:log:5"}, "longer than the run"},
      {{"--vary", "iteratons=1,2", "--engine", "ode:quickstep"}, "did you mean 'iterations'"},
      {{"--vary", "erp=0.5,2", "--engine", "ode"}, "erp cannot be '2'"},
      {{"--vary", "dt=1/100..1/10:100000", "--vary", "scene.body.cube.mass=1..2:10000", "--engine", "ode"},
       "1000000000 cells; allowed: at most 1000000"},
      {{"--vary", "dt=1/100,1/10", "--dt", "1/20"}, "--dt and --vary dt"},
      {{"--vary", "dt=1/100,1/10", "--vary", "dt=1/20,1/30"}, "varied twice"},
      {{"--vary", "dt=1/100,1/10", "--metric", "position_eror"}, "did you mean 'position_error'"},
      {{"--vary", "dt=1/100,1/10", "--sample", "0"}, "--sample"},
  };
  for (const Row& row : rows) {
    const Answer answer = sweep(row.words);
    BOOST_TEST(answer.code == 2, row.expected);
    BOOST_TEST(answer.err.find(row.expected) != std::string::npos, answer.err);
    BOOST_TEST(!std::filesystem::exists(path("out/sweep.csv")), row.expected);
  }
}

// Half-way through it is killed; what goes on from there makes the very same table.
BOOST_AUTO_TEST_CASE(a_killed_sweep_goes_on_to_the_same_table) {
  const std::string words =
      " sweep spring --vary scene.spring[0].stiffness=1e3..1e5:log:150 --engine ode --dt 1/1000"
      " --duration 20 --suite suite --jobs 2 --out ";
  const std::string begin = "cd '" + folder.path.string() + "' || exit 9; ";
  BOOST_TEST(std::system((begin + RIGOR_PROGRAM + words + "whole >/dev/null 2>&1").c_str()) == 0);
  const std::string journal = "out/.rigor-partial/journals/sweep.journal";
  const std::string kill_half_way = " & p=$!; for i in $(seq 1200); do [ \"$(stat -c %s " + journal +
                                    " 2>/dev/null || echo 0)\" -gt 300 ] && break; sleep 0.05; done; kill -KILL $p";
  BOOST_TEST(
      std::system((begin + "{ " + RIGOR_PROGRAM + words + "out >/dev/null 2>&1" + kill_half_way + "; }").c_str()) == 0);
  BOOST_TEST(!std::filesystem::exists(path("out/sweep.csv")));
  BOOST_TEST(std::filesystem::file_size(path(journal)) > 300);  // it had got somewhere
  BOOST_TEST(std::system((begin + RIGOR_PROGRAM + words + "out --resume >/dev/null 2>&1").c_str()) == 0);
  BOOST_TEST(content("out/sweep.csv") == content("whole/sweep.csv"));
}

BOOST_AUTO_TEST_SUITE_END()
