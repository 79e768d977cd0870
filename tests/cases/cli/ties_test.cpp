// Scenes whose outcome depends on which bodies meet first, by the program itself: it names the instant and the bodies.
#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_ties {

using Json = nlohmann::json;

// A ball meets two others in one instant, or one of them 1 mm earlier.
std::string three_balls(double earlier) {
  return fmt::format(R"(title = "A ball meets two others"
[scene]
contact_default = {{ restitution = 1, friction = 0 }}
[[scene.body]]
name = "cue"
mass = 1
position = [-1, 0, 0]
velocity = [1, 0, 0]
shape = {{ type = "sphere", radius = 0.1 }}
[[scene.body]]
name = "left"
mass = 1
position = [{}, 0.11, 0]
shape = {{ type = "sphere", radius = 0.1 }}
[[scene.body]]
name = "right"
mass = 1
position = [0, -0.11, 0]
shape = {{ type = "sphere", radius = 0.1 }}
[run]
duration = 2
dt = ["1/60"]
[truth]
kind = "events"
)",
                     -earlier);
}

// A plate lands on two posts that are not equally far from its centre.
constexpr const char* kPlate = R"(title = "A plate lands on two edges"
[scene]
gravity = [0, 0, -9.81]
contact_default = { restitution = 0.5, friction = 0.5 }
[[scene.body]]
name = "plate"
mass = 1
position = [0, 0, 0.5]
shape = { type = "box", size = [1, 0.4, 0.1] }
[[scene.body]]
name = "post"
position = [-0.3, 0, 0.1]
shape = { type = "box", size = [0.1, 0.4, 0.2] }
fixed = true
[[scene.body]]
name = "step"
position = [0.4, 0, 0.1]
shape = { type = "box", size = [0.1, 0.4, 0.2] }
fixed = true
[run]
duration = 1
dt = ["1/60"]
[truth]
kind = "events"
)";

struct Fixture : Program {
  Fixture() {
    folder.write("tie.toml", three_balls(0)), folder.write("none.toml", three_balls(1e-3));
    folder.write("plate.toml", kPlate);
  }

  // The text without line breaks and indents.
  static std::string in_one_line(const std::string& text) {
    std::string line;
    for (const char c : text) {
      const char next = c == '\n' ? ' ' : c;
      if (next != ' ' || line.empty() || line.back() != ' ') line += next;
    }
    return line;
  }
};

constexpr const char* kOfBalls = "several pairs meet in one instant: 'cue' and 'left', 'cue' and 'right'.";
constexpr const char* kOfPlate = "several pairs meet in one instant: 'plate' and 'post', 'plate' and 'step'.";

}  // namespace cases_cli_ties

BOOST_FIXTURE_TEST_SUITE(cases_cli_ties, Fixture)

BOOST_AUTO_TEST_CASE(a_run_names_the_bodies_of_a_tie_and_the_instant) {
  for (const auto& [file, pairs] : {std::pair("tie.toml", kOfBalls), {"plate.toml", kOfPlate}}) {
    const Answer brief = run({"run", file, "--engine", "ode", "--out", "out"});
    BOOST_TEST_REQUIRE(brief.code == 0, brief.err);
    BOOST_TEST(in_one_line(brief.out).find(pairs) != std::string::npos, brief.out);
    BOOST_TEST(in_one_line(content("out/report.md")).find(pairs) != std::string::npos);
    const Json truth = Json::parse(content("out/results.json")).at("cases")[0].at("truth");
    BOOST_TEST(truth.at("caveat").get<std::string>().find(pairs) != std::string::npos);
    BOOST_TEST(truth.at("horizon").get<double>() < 0.9);
  }
}

BOOST_AUTO_TEST_CASE(the_truth_names_the_tie_and_claims_no_small_error_after_it) {
  for (const auto& [file, pairs, before] : {std::tuple("tie.toml", kOfBalls, "1/2"), {"plate.toml", kOfPlate, "1/5"}}) {
    const Answer answer = run({"truth", file, "--times", std::string(before) + ",1"});
    BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
    BOOST_TEST(in_one_line(answer.err).find(pairs) != std::string::npos, answer.err);
    std::vector<double> errors;
    std::istringstream lines(answer.out);
    for (std::string line; std::getline(lines, line);) {
      const std::string last = line.substr(line.rfind(',') + 1);
      if (last != "error") errors.push_back(std::stod(last));
    }
    BOOST_TEST_REQUIRE(errors.size() >= 4u);
    BOOST_TEST(errors.front() < 1e-8);
    BOOST_TEST(errors.back() >= 1);
  }
}

BOOST_AUTO_TEST_CASE(a_scene_without_a_tie_is_not_said_to_have_one) {
  BOOST_TEST(run({"run", "none.toml", "--engine", "ode", "--out", "out"}).out.find("one instant") == std::string::npos);
  BOOST_TEST(run({"truth", "none.toml"}).err.find("one instant") == std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
