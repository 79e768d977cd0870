// A JSON Schema against TOML files, by ajv, which comes with the HTML report's page. Included after Boost.Test, whose
// macros the TOML library must not see. For files to which RIGOR_SOURCE_DIR is told.
#pragma once

#include <sys/wait.h>
#include <toml++/toml.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "generated/tests/places.h"
#include "tests/folder.h"

namespace rigor::test {

using Json = nlohmann::ordered_json;

inline std::string content(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// JSON has no infinity: the word that the reader takes for it.
inline Json as_json(const toml::node& node) {
  if (const auto* table = node.as_table()) {
    Json out = Json::object();
    for (const auto& [key, value] : *table) out[std::string(key.str())] = as_json(value);
    return out;
  }
  if (const auto* array = node.as_array()) {
    Json out = Json::array();
    for (const toml::node& value : *array) out.push_back(as_json(value));
    return out;
  }
  if (const auto number = node.as_floating_point()) {
    return std::isinf(number->get()) ? Json("infinite") : Json(number->get());
  }
  if (const auto number = node.as_integer()) return number->get();
  if (const auto flag = node.as_boolean()) return flag->get();
  return node.value_or(std::string());
}

// Checks that every file of `valid` is accepted, and every one of `broken` is rejected.
inline void check_by_ajv(const std::string& schema, const Json& valid, const Json& broken) {
  const Folder folder;
  const std::string files = folder.write("valid.json", valid.dump()) + " " + folder.write("broken.json", broken.dump());
  const std::string said = (folder.path / "said").string();
  const int answer = std::system(("node " RIGOR_SOURCE_DIR "/tests/cases/case/case_schema_test.mjs " RIGOR_BUILD_DIR
                                  "/page/node_modules " +
                                  schema + " " + files + " >" + said + " 2>&1")
                                     .c_str());
  BOOST_TEST_CONTEXT(content(said)) { BOOST_TEST((WIFEXITED(answer) && WEXITSTATUS(answer) == 0)); }
}

}  // namespace rigor::test
