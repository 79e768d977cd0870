// A run whose truth is made by its own code, by the program itself: its errors stand in brackets, and it wins nothing.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_held_to_itself {

using Json = nlohmann::json;

constexpr const char* kBounces = R"(title = "A ball that bounces, its truth by events"
[scene]
gravity = [0, -9.8, 0]
contact_default = { restitution = 0.5, friction = 0.3 }
[[scene.body]]
name = "ball"
mass = 1
position = [0, 1, 0]
shape = { type = "sphere", radius = 0.1 }
[[scene.body]]
name = "floor"
shape = { type = "plane", normal = [0, 1, 0], offset = 0 }
[run]
duration = 1
dt = ["1/30", "1/240", "1/1000"]
[truth]
kind = "events"
)";

struct Fixture : Program {
  Fixture() { folder.write("ball.toml", kBounces); }
};

}  // namespace cases_cli_held_to_itself

BOOST_FIXTURE_TEST_SUITE(cases_cli_held_to_itself, Fixture)

BOOST_AUTO_TEST_CASE(its_errors_are_marked_and_compared_with_no_engine) {
  const Answer answer = run({"run", "ball.toml", "--engine", "ode", "--engine", "core:rk4,contact=event", "--engine",
                             "core:rk4,contact=impulse", "--verbose", "--out", "out"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  BOOST_TEST(answer.out.find("What it finds of these stands in brackets.") != std::string::npos, answer.out);
  const Json results = Json::parse(content("out/results.json"));
  for (const Json& cell : results.at("cells")) {
    const bool is_itself = cell.at("engine") == "core:rk4,contact=event";
    BOOST_TEST(cell.at("metrics").at("position_error").contains("held_to_itself") == is_itself, cell.at("engine"));
    BOOST_TEST(!cell.at("metrics").at("penetration").contains("held_to_itself"));  // the scene's own witness
  }
  bool is_any_compared = false;
  for (const Json& table : results.at("cases")[0].at("work_precision")) {
    for (const Json& point : table.at("points")) BOOST_TEST(point.at("engine") != "core:rk4,contact=event");
    for (const Json& point : table.at("at_equal_cost")) {
      is_any_compared = true;
      BOOST_TEST(point.at("engine") == "core:rk4,contact=impulse");
    }
  }
  BOOST_TEST(is_any_compared);
}

// A sweep's tables say it of each metric by its name, whole or in parts.
BOOST_AUTO_TEST_CASE(a_sweep_marks_its_errors) {
  const std::vector<std::string> sweep = {
      "sweep",  "ball.toml",     "--engine", "core:rk4,contact=event", "--engine", "ode",
      "--vary", "dt=1/30,1/240", "--metric", "position_error",         "--metric", "penetration"};
  const auto with = [](std::vector<std::string> words, const std::vector<std::string>& more) {
    return words.insert(words.end(), more.begin(), more.end()), words;
  };
  const Answer answer = run(with(sweep, {"--out", "whole"}));
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  std::istringstream lines(content("whole/sweep.jsonl")), csv(content("whole/sweep.csv"));
  std::string line, of_csv;
  std::getline(csv, of_csv);
  BOOST_TEST(of_csv.ends_with(",reason,held_to_itself"), of_csv);
  int rows = 0;
  for (; std::getline(lines, line) && std::getline(csv, of_csv); ++rows) {
    const Json row = Json::parse(line);
    const bool is_itself = row.at("engine") == "core:rk4,contact=event";
    BOOST_TEST(row.at("held_to_itself") == (is_itself ? Json::array({"position_error"}) : Json::array()), line);
    BOOST_TEST(of_csv.ends_with(",position_error") == is_itself, of_csv);
  }
  BOOST_TEST(rows == 4);
  BOOST_TEST(content("whole/sweep.html").find("position_error (") != std::string::npos);
  for (const std::string part : {"1", "2"})
    BOOST_TEST(run(with(sweep, {"--shard", part + "/2", "--out", "part" + part})).code == 0);
  BOOST_TEST(run({"merge", "part1", "part2", "--out", "merged"}).code == 0);
  BOOST_TEST(content("merged/sweep.csv") == content("whole/sweep.csv"));
}

BOOST_AUTO_TEST_CASE(it_is_no_winner_of_a_tuning) {
  const Answer answer = run({"tune", "ball.toml", "--engine", "core:rk4,contact=event", "--within", "1mm"});
  BOOST_TEST(answer.code == 1, answer.out);
  BOOST_TEST(answer.out.find("made by the same code as this run") != std::string::npos, answer.out);
  BOOST_TEST(answer.out.find("winner") == std::string::npos, answer.out);
}

BOOST_AUTO_TEST_SUITE_END()
