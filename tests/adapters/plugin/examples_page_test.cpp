// All examples of plug-ins in one report, made by the commands in adapters/plugin/README.md, and checked in a headless
// Chromium.
#include <sys/wait.h>

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "generated/tests/places.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_plugin_examples_page, *boost::unit_test::enable_if<RIGOR_HTML_REPORT>())

namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The commands of the page's section on the registry's engines.
std::string documented_commands() {
  const std::string page = content(RIGOR_SOURCE_DIR "/adapters/plugin/README.md");
  const std::size_t from = page.find("```sh\n", page.find("## The engines of the npm registry")) + 6;
  return page.substr(from, page.find("```", from) - from);
}

bool succeeds(const std::string& commands, const Folder& folder) {
  folder.write("commands.sh", commands);
  const std::string call =
      "cd " + folder.path.string() + " && PATH=" RIGOR_BUILD_DIR ":$PATH sh -e commands.sh >said 2>&1 </dev/null";
  const int answer = std::system(call.c_str());
  const bool good = WIFEXITED(answer) && WEXITSTATUS(answer) == 0;
  if (!good) BOOST_TEST_MESSAGE(content(folder.path / "said"));
  return good;
}

}  // namespace

// npm is there where the HTML report is made.
BOOST_AUTO_TEST_CASE(seven_examples_make_one_page_by_the_documented_commands) {
  const Folder folder;
  const std::filesystem::path to = folder.path / "adapters/plugin";
  std::filesystem::create_directories(to);
  std::filesystem::copy(RIGOR_SOURCE_DIR "/adapters/plugin/rigor_engine.h", to);
  std::filesystem::copy(RIGOR_SOURCE_DIR "/adapters/plugin/examples", to / "examples",
                        std::filesystem::copy_options::recursive);
  BOOST_TEST_REQUIRE(succeeds(documented_commands(), folder));
  const std::string out = (to / "examples/npm/out/").string();
  BOOST_TEST(succeeds("node " RIGOR_SOURCE_DIR "/tests/adapters/plugin/examples_page_test.mjs " + out + "report.html " +
                          out + "results.json " RIGOR_BUILD_DIR "/screenshots/examples",
                      folder));
}

BOOST_AUTO_TEST_SUITE_END()
