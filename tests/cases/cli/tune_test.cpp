// rigor tune, by the program itself: that its winner keeps the bound, is coarse enough, and that it says no.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_tune {

using Json = nlohmann::json;

struct Fixture : Program {
  Fixture() { folder.write("stone.toml", kThrown); }
  Answer tune(std::vector<std::string> words) const {
    words.insert(words.begin(), {"tune", "stone.toml", "--jobs", "2"});
    return run(words);
  }
};

std::string found(const std::string& text, const std::string& pattern) {
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern)) ? match[1].str() : "";
}

}  // namespace cases_cli_tune

BOOST_FIXTURE_TEST_SUITE(cases_cli_tune, Fixture)

// 5 m/s × dt up to 1 cm asks for 1/500 s: of the steps that are tried that very one.
BOOST_AUTO_TEST_CASE(the_winner_is_the_coarsest_step_that_theory_allows) {
  const Answer answer = tune({"--engine", "ode:worldstep", "--within", "1.001cm"});
  BOOST_TEST(answer.code == 0, answer.err);
  BOOST_TEST(found(answer.out, "winner: \\S+ at (\\S+) s") == "1/500", answer.out);
  BOOST_TEST(answer.out.find("dWorldStep(world, 1.0 / 500);") != std::string::npos, answer.out);
  BOOST_TEST(answer.out.find("without effect here: ") != std::string::npos, answer.out);
  BOOST_TEST(answer.out.find("the other engines, with at most 16 settings each") != std::string::npos);
  BOOST_TEST(found(answer.out, "beyond the bounds:\n +stone.toml: (\\S+), position_error ") == "stable", answer.out);
  // And the run that it names keeps the bound.
  const std::string engine = found(answer.out, "--engine (\\S+)");
  BOOST_TEST(run({"run", "stone.toml", "--engine", engine, "--dt", "1/500", "--out", "out"}).code == 0);
  const Json cell = Json::parse(content("out/results.json")).at("cells")[0];
  BOOST_TEST(cell.at("metrics").at("position_error").at("value").get<double>() <= 0.01001);
}

BOOST_AUTO_TEST_CASE(where_nothing_keeps_the_bound_the_exit_code_is_1_and_the_nearest_is_named) {
  const Answer answer = tune({"--engine", "ode", "--within", "1um"});  // it would take 1/5000000 s
  BOOST_TEST(answer.code == 1, answer.out);
  BOOST_TEST(answer.out.find("no setting of ode keeps 1um") != std::string::npos, answer.out);
  BOOST_TEST(answer.out.find("comes nearest") != std::string::npos, answer.out);
  BOOST_TEST(answer.out.find("winner") == std::string::npos);
  BOOST_TEST(found(answer.out, "(core:\\S+)\n") != "", answer.out);  // exact for a parabola
}

BOOST_AUTO_TEST_CASE(a_bound_on_what_is_not_measured_is_never_kept) {
  const Answer answer = tune({"--engine", "ode", "--within", "restitution_error=0.1"});
  BOOST_TEST(answer.code == 1, answer.out);
  BOOST_TEST(answer.out.find("restitution_error: ") != std::string::npos, answer.out);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_tuned_is_refused) {
  struct Row {
    std::vector<std::string> words;
    std::string expected;
  };
  const std::vector<Row> rows = {{{"--engine", "ode"}, "--within BOUND"},
                                 {{"--within", "1mm"}, "exactly one --engine"},
                                 {{"--engine", "ode", "--within", "1"}, "no unit"},
                                 {{"--engine", "ode", "--within", "mm"}, "--within"},
                                 {{"--engine", "ode", "--within", "-1mm"}, "--within"},
                                 {{"--engine", "ode", "--within", "0mm"}, "greater than 0"},
                                 {{"--engine", "ode", "--within", "1furlong"}, "unit is 'furlong'"},
                                 {{"--engine", "ode", "--within", "position_eror=1"}, "did you mean 'position_error'"},
                                 {{"--engine", "ode", "--within", "survival=1"}, "no metric 'survival' to bound"},
                                 {{"--engine", "ode", "--within", "1mm", "--within", "2mm"}, "both bound"},
                                 {{"--engine", "od", "--within", "1mm"}, "did you mean 'ode'"}};
  for (const Row& row : rows) {
    const Answer answer = tune(row.words);
    BOOST_TEST(answer.code == 2, row.expected);
    BOOST_TEST(answer.err.find(row.expected) != std::string::npos, answer.err);
    BOOST_TEST(answer.out == "");
  }
}

BOOST_AUTO_TEST_SUITE_END()
