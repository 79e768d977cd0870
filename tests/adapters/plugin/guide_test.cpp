// Follows the guide "Bring your own engine" in adapters/README.md: saves its pieces of awk one after another, and runs
// its commands in between.
#include <sys/wait.h>

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "generated/tests/places.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_plugin_guide)

namespace {

struct Block {
  std::string language, text;
};

// The fenced blocks of the guide.
std::vector<Block> blocks() {
  std::ifstream file(RIGOR_SOURCE_DIR "/adapters/README.md");
  std::vector<Block> found;
  bool is_guide = false, is_inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("## ")) is_guide = line == "## Bring your own engine";
    if (!is_guide) continue;
    if (line.starts_with("```")) {
      is_inside = !is_inside;
      if (is_inside) found.push_back({line.substr(3), ""});
    } else if (is_inside) {
      found.back().text += line + "\n";
    }
  }
  return found;
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_line_of_it_works) {
  const Folder folder;
  const std::string in = folder.path.string();
  std::string engine;
  int pieces = 0, commands = 0;
  for (const Block& block : blocks()) {
    BOOST_TEST_CONTEXT(block.text) {
      if (block.language == "awk") {
        engine += block.text, ++pieces;
        folder.write("engine.awk", engine);
        continue;
      }
      BOOST_TEST_REQUIRE(block.language == "sh");
      folder.write("commands.sh", block.text);
      const std::string call =
          "cd " + in + " && PATH=" RIGOR_BUILD_DIR ":$PATH sh -e commands.sh >said 2>&1 </dev/null";
      const int answer = std::system(call.c_str());
      std::ifstream said(folder.path / "said");
      const std::string text((std::istreambuf_iterator<char>(said)), {});
      BOOST_TEST((WIFEXITED(answer) && WEXITSTATUS(answer) == 0), text);
      ++commands;
    }
  }
  BOOST_TEST((pieces == 4 && commands == 4));
}

// engine.pl knows no more of Rigor than the guide says, and its language is none of the examples'.
BOOST_AUTO_TEST_CASE(an_engine_in_perl_that_follows_it_conforms) {
  const Folder folder;
  const std::string said = (folder.path / "said").string();
  const std::string call =
      RIGOR_PROGRAM " conform --plugin 'perl " RIGOR_SOURCE_DIR "/tests/adapters/plugin/engine.pl' >" + said + " 2>&1";
  const int answer = std::system(call.c_str());
  std::ifstream file(said);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  BOOST_TEST((WIFEXITED(answer) && WEXITSTATUS(answer) == 0), text);
  BOOST_TEST(text.find("perl conforms") != std::string::npos, text);
}

BOOST_AUTO_TEST_SUITE_END()
