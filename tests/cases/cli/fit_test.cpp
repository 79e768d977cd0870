// rigor fit, by the program itself: the values of --json are those of the analysis and of the text.
#include "cases/analysis/fitting/fitting.h"

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/cases/cli/program.h"
#include "tests/cases/noisy_recording.h"

using namespace rigor;
using Json = nlohmann::json;

namespace {

const std::string kFriction = "scene.contact_default.friction";

struct FitFixture : Program {
  FitFixture() {
    folder.write("slide.csv", test::sliding_recording(0.3, 8, 1));
    folder.write("slide.toml", test::recorded_case(0.5, "slide.csv"));
  }
  Answer fitted(const std::vector<std::string>& vary, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"fit", "slide.toml", "--engine", "core:velocity-verlet"};
    for (const std::string& one : vary) words.insert(words.end(), {"--vary", one});
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
};

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

BOOST_FIXTURE_TEST_SUITE(cases_cli_fit, FitFixture)

BOOST_AUTO_TEST_CASE(json_has_the_numbers_of_the_analysis) {
  const Answer answer =
      fitted({kFriction + "=0.05..0.9"}, {"--json", "--seed", "7", "--hold-out", "0.25", "--out", "fitted.toml"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  const Json all = Json::parse(answer.out);
  BOOST_TEST_REQUIRE(all.size() == 1u);

  FitInput input;
  input.cases = {read_case(path("slide.toml"), "slide", test::words())};
  input.run = parse_run_name("core:velocity-verlet", test::words().engines);
  input.axes = {parse_axis(kFriction + "=0.05..0.9", true)};
  input.hold_out = 0.25, input.seed = 7;
  const FitResult due = fit(input, engines(), test::words());
  const Json& parameter = all[0].at("parameters").at(0);
  BOOST_TEST(parameter.at("value") == due.parameters[0].number);
  BOOST_TEST(parameter.at("interval").at(0) == due.parameters[0].interval->first);
  BOOST_TEST(parameter.at("interval").at(1) == due.parameters[0].interval->second);
  BOOST_TEST(parameter.at("unit") == "1");
  BOOST_TEST(parameter.at("at_bound") == false);
  BOOST_TEST(parameter.at("unknown") == "");
  BOOST_TEST(all[0].at("points") == due.points);
  BOOST_TEST(all[0].at("fitted").at("trials") == 6);
  BOOST_TEST(all[0].at("held_out").at("trials") == 2);
  BOOST_TEST(all[0].at("held_out").at("position") == due.held_out->position);
  BOOST_TEST(all[0].at("held_out").at("position_unit") == "%");
  // Degrees are radians there.
  BOOST_TEST(all[0].at("held_out").at("rotation").get<double>() * 180 / M_PI == due.held_out->rotation,
             boost::test_tools::tolerance(1e-15));
  BOOST_TEST(holds(content("fitted.toml"), "friction = " + parameter.at("text").get<std::string>()));
}

BOOST_AUTO_TEST_CASE(text_and_json_say_the_same) {
  const std::vector<std::string> vary = {kFriction + "=0.4..0.9", "scene.body.block.velocity[1]=-1..1"};
  const std::string text = fitted(vary).out;
  const Json found = Json::parse(fitted(vary, {"--json"}).out)[0];
  const Json &friction = found.at("parameters").at(0), &start = found.at("parameters").at(1);
  BOOST_TEST(friction.at("at_bound") == true);
  BOOST_TEST(holds(text, fmt::format("{} = {:.4g}", kFriction, friction.at("value").get<double>())), text);
  BOOST_TEST(holds(text, "at the end of its range"), text);
  BOOST_TEST(start.at("unknown") == "it changes nothing here");
  BOOST_TEST(start.at("interval").is_null());
  BOOST_TEST(start.at("unit") == "m/s");
  BOOST_TEST(holds(text, "the data cannot tell it: it changes nothing here"), text);
}

BOOST_AUTO_TEST_CASE(one_trial_has_an_interval_and_says_which_end_is_open) {
  folder.write("slide.csv", test::noisy_recording(test::sliding_scene(0.3), 1, 1));
  const std::string text = fitted({kFriction + "=0.05..0.9"}).out;
  const Json row = Json::parse(fitted({kFriction + "=0.05..0.9"}, {"--json"}).out)[0];
  const Json& known = row.at("parameters").at(0);
  BOOST_TEST(row.at("intervals") == "profile");
  BOOST_TEST(row.at("caveats").empty());
  BOOST_TEST(known.at("open_ends") == Json({false, false}));
  BOOST_TEST(holds(text, fmt::format("95 %: {:.4g} to {:.4g}", known.at("interval").at(0).get<double>(),
                                     known.at("interval").at(1).get<double>())),
             text);
  const std::string bound = fitted({kFriction + "=0.3025..0.9"}).out;
  BOOST_TEST(holds(bound, "95 %: at most 0.30"), bound);
  BOOST_TEST(holds(bound, "at the end of its range"), bound);
}

// Ten tosses have a rough loss. A value without an interval says why, and never that its interval is the whole range:
// of those, an end of the range has been seen to fit worse.
BOOST_AUTO_TEST_CASE(no_value_is_without_an_interval_or_a_reason) {
  const Answer answer = run({"fit", "reality/synthetic-tosses", "--engine", "bullet", "--dt", "1/148", "--vary",
                             kFriction + "=0.02..0.6", "--vary", "scene.body.cube.inertia=6e-4..9e-4", "--json"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  const Json all = Json::parse(answer.out);
  for (const Json& parameter : all.at(0).at("parameters")) {
    const bool is_unknown = parameter.at("unknown") != "";
    BOOST_TEST(parameter.at("interval").is_null() == is_unknown, parameter);
    BOOST_TEST(!holds(parameter.at("unknown").get<std::string>(), "whole range"), parameter);
  }
}

BOOST_AUTO_TEST_CASE(several_engines_are_several_rows) {
  const Answer answer = fitted({kFriction + "=0.05..0.9"}, {"--json", "--engine", "core:semi-implicit-euler"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  const Json all = Json::parse(answer.out);
  BOOST_TEST_REQUIRE(all.size() == 2u);
  BOOST_TEST(all[0].at("run") == "core:velocity-verlet");
  BOOST_TEST(all[1].at("run") == "core:semi-implicit-euler");
}

BOOST_AUTO_TEST_CASE(what_cannot_be_fitted_is_refused) {
  const auto refusal = [&](const std::string& vary, const std::vector<std::string>& more = {}) {
    const Answer answer = fitted({vary}, more);
    BOOST_TEST(answer.code == 2, answer.err);
    BOOST_TEST(answer.out == "");
    return answer.err;
  };
  BOOST_TEST(holds(refusal("scene.contact_default.fricton=0.1..0.9", {"--json"}), "did you mean 'friction'?"));
  BOOST_TEST(holds(refusal(kFriction + "=0.9..0.1", {"--json"}), "the wrong way round; give 0.1..0.9"));
  BOOST_TEST(holds(refusal(kFriction + "=0.1..0.9", {"--hold-out", "1"}), "between 0 and 1"));
  BOOST_TEST(holds(refusal(kFriction + "=0.1..0.9", {"--dt", "1/100", "--dt", "1/200"}), "at most one --dt"));
}

BOOST_AUTO_TEST_SUITE_END()
