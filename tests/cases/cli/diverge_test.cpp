// rigor diverge, by the program itself: its lines, its JSON and its exit codes.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_diverge {

using Json = nlohmann::json;

constexpr const char* kTop = R"(title = "a top"
[scene]
[[scene.body]]
name = "top"
mass = 2
inertia = [1, 2, 3]
angular_velocity = [1.1, 0.7, -0.9]
[run]
duration = 3
dt = ["1/100"]
[truth]
kind = "asymmetric-top"
)";

struct Fixture : Program {
  Fixture() { folder.write("top.toml", kTop), folder.write("cube.toml", kSprungCube); }
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
