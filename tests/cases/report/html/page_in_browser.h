// Runs the scripts that test a page in a headless Chromium.
#pragma once

#include <sys/wait.h>

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "generated/tests/places.h"
#include "tests/folder.h"

namespace rigor::test {

inline const std::string kHere = RIGOR_SOURCE_DIR "/tests/cases/report/html/";
inline const std::string kModules = RIGOR_BUILD_DIR "/page/node_modules";

inline std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Runs a command whose words hold no quotes, and shows what it said if it fails.
inline bool succeeds(const std::string& command, const Folder& folder) {
  const std::string said = (folder.path / "said").string();
  const int answer = std::system((command + " >" + said + " 2>&1").c_str());
  const bool good = WIFEXITED(answer) && WEXITSTATUS(answer) == 0;
  if (!good) BOOST_TEST_MESSAGE(command << "\n" << content(said));
  return good;
}

inline bool opens_well(const std::string& script, const Folder& folder, const std::string& page,
                       const std::string& results, const std::string& name) {
  const std::string shots = RIGOR_BUILD_DIR "/screenshots/" + name;
  return succeeds(
      "RIGOR_PAGE_MODULES=" + kModules + " node " + kHere + script + " " + page + " " + results + " " + shots, folder);
}

}  // namespace rigor::test
