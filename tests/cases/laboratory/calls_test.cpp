// The laboratory's calls as a page makes them: JSON in, JSON and numbers out.
#include "cases/laboratory/calls.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/repeats/recorded_states.h"
#include "core/base/json.h"
#include "generated/tests/places.h"
#include "tests/folder.h"
#include "tests/scenes.h"

BOOST_AUTO_TEST_SUITE(cases_laboratory_calls)

namespace {

using namespace rigor;

std::string suite_text(const std::string& id) {
  std::ifstream in(RIGOR_SOURCE_DIR "/cases/suite/" + id + ".toml");
  return {std::istreambuf_iterator<char>(in), {}};
}

Json request(const std::string& call, const std::string& id) {
  return {{"call", call}, {"path", id + ".toml"}, {"text", suite_text(id)}};
}

Json asked(LaboratoryCalls& calls, const Json& json) { return parse_json(calls.answer(json.dump())); }

Json answered(LaboratoryCalls& calls, const Json& json) {
  Json answer = asked(calls, json);
  BOOST_TEST_REQUIRE(answer.at("ok").get<bool>(), answer.dump());
  return answer;
}

}  // namespace

BOOST_AUTO_TEST_CASE(reading_says_what_a_scene_has) {
  LaboratoryCalls calls;
  const Json facts = answered(calls, request("read", "springs/fixed-spring"));
  BOOST_TEST(facts.at("duration") == 5);
  BOOST_TEST(facts.at("truth") == "reference");
  BOOST_TEST(facts.at("knobs").size() == 4u);
  BOOST_TEST(facts.at("knobs")[0].at("value") == 1e4);
  BOOST_TEST(facts.at("lacks").empty());
  BOOST_TEST(facts.at("scene").at("bodies").size() + 0u == 1u);
  const Json jointed = answered(calls, request("read", "joints/pendulum-90"));
  BOOST_TEST(jointed.at("lacks").contains("adams"));
}

BOOST_AUTO_TEST_CASE(a_broken_file_is_refused_with_its_line) {
  LaboratoryCalls calls;
  Json broken = request("read", "springs/fixed-spring");
  std::string text = broken.at("text");
  text.replace(text.find("mass = 100"), 10, "mas  = 100");
  broken["text"] = text;
  const Json answer = asked(calls, broken);
  BOOST_TEST(!answer.at("ok").get<bool>());
  const std::string why = answer.at("why");
  BOOST_TEST(why.starts_with("springs/fixed-spring.toml:"), why);
  BOOST_TEST(why.find("mass") != std::string::npos, why);
}

// A robot comes as the text of a case file, which the other calls take.
BOOST_AUTO_TEST_CASE(a_robot_becomes_a_case_file) {
  LaboratoryCalls calls;
  Json import = {{"call", "import"}, {"path", RIGOR_SOURCE_DIR "/tests/cases/import/models/quadruped.urdf"}};
  const Json alone = answered(calls, import);
  BOOST_TEST(!alone.at("falls").get<std::string>().empty());
  import["ground"] = true;
  const Json robot = answered(calls, import);
  BOOST_TEST(robot.at("falls").get<std::string>().empty());
  BOOST_TEST(robot.at("text") != alone.at("text"));
  const Json facts = answered(calls, {{"call", "read"}, {"path", "quadruped.urdf"}, {"text", robot.at("text")}});
  BOOST_TEST(facts.at("title").get<std::string>().find("as its URDF file has it") != std::string::npos);
  BOOST_TEST(!facts.at("lacks").contains("semi-implicit-euler"));
}

BOOST_AUTO_TEST_CASE(a_broken_robot_is_refused_with_its_line) {
  const Folder folder;
  const std::string path = folder.write("robot.urdf", R"(<robot name="x">
<link name="a">
<inertial><mass value="heavy"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
</link>
</robot>
)");
  LaboratoryCalls calls;
  const Json answer = asked(calls, {{"call", "import"}, {"path", path}});
  BOOST_TEST(!answer.at("ok").get<bool>());
  const std::string why = answer.at("why");
  BOOST_TEST(why.starts_with(path + ":3:"), why);
  BOOST_TEST(why.find("heavy") != std::string::npos, why);
}

BOOST_AUTO_TEST_CASE(every_case_that_a_browser_can_read_has_a_run_or_a_reason) {
  LaboratoryCalls calls;
  for (const char* id : {"springs/fixed-spring", "springs/body-springs", "contact/collision",
                         "ballistic/orientation-updates", "joints/double-pendulum", "soft-contact/elastic-ball"}) {
    Json load = request("load", id);
    load["run"] = "core", load["dt"] = "1/30";
    answered(calls, load);
    const Json stepped = answered(calls, {{"call", "step"}, {"count", 3}});
    BOOST_TEST(stepped.at("steps") == 3, id);
    const std::size_t bodies = answered(calls, request("read", id)).at("scene").at("bodies").size();
    answered(calls, {{"call", "step"}, {"count", 1}});
    BOOST_TEST(calls.numbers().size() == 6 + 7 * bodies, id);
  }
}

BOOST_AUTO_TEST_CASE(a_run_compared_with_the_truth_is_explained_in_the_words_of_the_report) {
  LaboratoryCalls calls;
  Json load = request("load", "springs/fixed-spring");
  load["run"] = "core:explicit-euler", load["dt"] = "1/30";
  answered(calls, load);
  Json truth = request("truth", "springs/fixed-spring");
  truth["dt"] = "1/30";
  Json header = answered(calls, truth);
  BOOST_TEST(header.at("kind") == "reference");
  BOOST_TEST(calls.numbers().size() == 14u * 151u);
  header["call"] = "compare";
  answered(calls, header);
  answered(calls, {{"call", "step"}, {"count", 150}});
  Json explain = request("explain", "springs/fixed-spring");
  explain["dt"] = "1/30";
  explain["runs"] = {{{"run", "core:explicit-euler"}, {"cell", answered(calls, {{"call", "judge"}}).at("cell")}}};
  const Json words = answered(calls, explain);
  BOOST_TEST_REQUIRE(!words.at("sentences").empty());
  const std::string text = words.at("sentences")[0].at("text");
  BOOST_TEST(text.find("In one step its energy grows by a factor of 1.43") != std::string::npos, text);
  const double omega_dt = words.at("mode").at("frequency").get<double>() / 30;
  BOOST_TEST(std::abs(words.at("mode").at("growth").at("core:explicit-euler").get<double>() - 1 - omega_dt * omega_dt) <
             1e-6);
}

BOOST_AUTO_TEST_CASE(sliders_act_on_the_run) {
  LaboratoryCalls calls;
  Json load = request("load", "contact/collision");
  load["run"] = "core:velocity-verlet,contact=event", load["dt"] = "1/100";
  load["knobs"] = {{"restitution", 0}, {"friction", "infinite"}};
  answered(calls, load);
  answered(calls, {{"call", "step"}, {"count", 100}});
  const double height = calls.numbers()[calls.numbers().size() - 14 + 1];
  BOOST_TEST(std::abs(height - 0.1) < 1e-9);  // it lies on the ground
}

BOOST_AUTO_TEST_CASE(hashes_are_those_of_rigor_repeat) {
  LaboratoryCalls calls;
  Json hashes = request("hashes", "springs/fixed-spring");
  hashes["run"] = "core:rk4", hashes["dt"] = "1/30", hashes["steps"] = 10;
  const std::string digits = answered(calls, hashes).at("hashes");
  const Engine& core = engines().find("core");
  Scene scene = rigor::test::fixed_spring();
  Settings settings;
  settings.method = "rk4";
  const auto due = hashes_of(recorded(core, settings, scene, 1.0 / 30, 10));
  BOOST_TEST_REQUIRE(digits.size() == 16 * due.size());
  for (std::size_t n = 0; n < due.size(); ++n)
    BOOST_TEST(std::stoull(digits.substr(16 * n, 16), nullptr, 16) == due[n]);
}

BOOST_AUTO_TEST_CASE(an_engine_from_outside_runs_beside_the_core) {
  LaboratoryCalls calls;
  const Json added = answered(
      calls, {{"call", "engine"}, {"command", "python3 " RIGOR_SOURCE_DIR "/adapters/plugin/examples/toy.py"}});
  const std::string name = added.at("engine");
  Json load = request("load", "ballistic/projectile");
  load["run"] = name, load["dt"] = "1/30";
  answered(calls, load);
  BOOST_TEST(answered(calls, {{"call", "step"}, {"count", 5}}).at("steps") == 5);
  const Json methods = answered(calls, {{"call", "methods"}}).at("methods");
  const bool is_listed =
      std::any_of(methods.begin(), methods.end(), [&](const Json& one) { return one.at("name") == name; });
  BOOST_TEST(is_listed);
}

BOOST_AUTO_TEST_CASE(wrong_calls_are_answered_and_never_thrown) {
  LaboratoryCalls calls;
  for (const char* text : {"", "{", "[]", "{\"call\":\"stop\"}", "{\"call\":\"step\",\"count\":1}",
                           "{\"call\":\"load\"}", "{\"call\":\"read\",\"path\":\"x\",\"text\":\"title = 1\"}"}) {
    const Json answer = parse_json(calls.answer(text));
    BOOST_TEST(!answer.at("ok").get<bool>(), text);
    BOOST_TEST(!answer.at("why").get<std::string>().empty(), text);
  }
}

BOOST_AUTO_TEST_SUITE_END()
