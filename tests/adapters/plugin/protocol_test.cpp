// The published JSON Schemas against what Rigor and an engine really say to each other, and what they must refuse.
#include <sys/wait.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "adapters/plugin/process_engine.h"
#include "cases/case/suite.h"
#include "core/engine/engine.h"
#include "core/scene/toml/writing/scene_writer.h"
#include "generated/tests/places.h"
#include "tests/cases/vocabulary.h"
#include "tests/folder.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_plugin_protocol)
using Json = nlohmann::ordered_json;

namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

long whole_lines_of(const std::filesystem::path& path) {
  const std::string text = content(path);
  return std::count(text.begin(), text.end(), '\n');
}

// tee hands a line on before it writes it down, so that an answer may be here before the file has it.
void wait_for_as_many_lines(const std::filesystem::path& some, const std::filesystem::path& others) {
  for (int n = 0; n < 1000 && whole_lines_of(some) != whole_lines_of(others); ++n)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

Json lines_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  Json lines = Json::array();
  for (std::string line; std::getline(file, line);) lines.push_back(Json::parse(line));
  return lines;
}

// What is said in a world with wrenches and one that runs many steps at a time, and to one that diverges.
Json recorded(const Folder& folder) {
  const std::string requests = (folder.path / "requests").string(), answers = (folder.path / "answers").string();
  const std::string toy = "python3 " RIGOR_SOURCE_DIR "/adapters/plugin/examples/toy.py";
  const ProcessEngine engine({"tee " + requests + " | " + toy + " | tee " + answers, 60, -1});
  Settings settings;
  settings.method = "euler";
  Snapshot now;
  const auto coupled = engine.load(test::coupled_bodies(0.5), settings),
             free = engine.load(test::tumbling_body(), settings);
  for (int n = 0; n < 3; ++n) coupled->step(0.01), coupled->read(now);
  expect_steps(*free, 0.01, 50, 10);
  for (int n = 0; n < 50; ++n) free->step(0.01);
  free->read(now);
  Scene lost = test::tumbling_body();
  lost.gravity = {1e308, 0, 0};
  const auto diverging = engine.load(lost, settings);
  for (int n = 0; n < 9; ++n) diverging->step(1);
  diverging->read(now);
  wait_for_as_many_lines(requests, answers);
  return {{"requests", lines_of(requests)}, {"answers", lines_of(answers)}};
}

Json scenes_of_suite() {
  Json scenes = Json::object();
  for (const Case& one : select_cases({}, default_suite_dir(), test::words()))
    scenes[one.id] = Json::parse(scene_json(one.scene));
  return scenes;
}

}  // namespace

// Uses ajv, which comes with the HTML report's page.
BOOST_AUTO_TEST_CASE(the_schemas_say_what_is_said, *boost::unit_test::enable_if<RIGOR_HTML_REPORT>()) {
  const Folder folder;
  const Json said = recorded(folder);
  BOOST_TEST_REQUIRE(said.at("requests").size() == said.at("answers").size());
  std::map<std::string, int> calls;
  for (const Json& request : said.at("requests")) ++calls[request.at("call")];
  for (const char* call : {"info", "load", "step", "read", "run"}) BOOST_TEST(calls[call] > 0, call);
  const std::string files =
      folder.write("said.json", said.dump()) + " " + folder.write("scenes.json", scenes_of_suite().dump());
  const std::string output = (folder.path / "output").string();
  const int answer = std::system(("node " RIGOR_SOURCE_DIR "/tests/adapters/plugin/protocol_test.mjs " RIGOR_BUILD_DIR
                                  "/page/node_modules " RIGOR_SOURCE_DIR "/adapters/plugin " +
                                  files + " >" + output + " 2>&1")
                                     .c_str());
  BOOST_TEST_CONTEXT(content(output)) { BOOST_TEST((WIFEXITED(answer) && WEXITSTATUS(answer) == 0)); }
}

BOOST_AUTO_TEST_SUITE_END()
