// Compares family.schema.json, which editors use for completion, with the reader's tables.
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <set>
#include <sstream>

#include "cases/case/family.h"
#include "cases/case/suite.h"
#include "core/base/error.h"
#include "tests/cases/case/schema.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;
using test::Json;

BOOST_AUTO_TEST_SUITE(cases_case_family_schema)
namespace fs = std::filesystem;

namespace {

const std::string kSchema = RIGOR_SOURCE_DIR "/cases/case/family.schema.json";

Json read(const std::string& file) { return Json::parse(test::content(file)); }

const Json& schema() {
  static const Json all = read(kSchema);
  return all;
}
const Json& gate_of(const Json& of) { return of.at("definitions").at("gate"); }

std::set<std::string> keys_of(const Json& table) {
  std::set<std::string> keys;
  for (const auto& [key, value] : table.items()) keys.insert(key);
  return keys;
}

// Of a family with one gate that has this line more; empty if the reader takes it.
std::string refusal_of(const std::string& line) {
  const Folder folder;
  try {
    read_family(folder.write("family.toml", "[[gate]]\nmetric = 'cost'\nmax = 1\nbecause = 'x'\n" + line + "\n"),
                test::words());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::set<std::string> allowed_by(const std::string& refusal) {
  const std::size_t at = refusal.rfind(": ");
  BOOST_TEST_REQUIRE(at != std::string::npos, refusal);
  std::istringstream list(refusal.substr(at + 2));
  std::set<std::string> words;
  for (std::string word; std::getline(list >> std::ws, word, ',');) words.insert(word);
  return words;
}

}  // namespace

BOOST_AUTO_TEST_CASE(has_the_keys_of_the_reader_and_no_others) {
  const Keys& read = family_gate_keys();
  BOOST_TEST((keys_of(gate_of(schema()).at("properties")) == std::set<std::string>(read.begin(), read.end())));
  BOOST_TEST((keys_of(schema().at("properties")) == std::set<std::string>{"gate"}));
}

BOOST_AUTO_TEST_CASE(has_the_words_for_scenes_of_the_reader_and_no_others) {
  std::set<std::string> known;
  const std::string pattern = schema().at("definitions").at("scene_word").at("pattern");
  const std::size_t begin = pattern.find('(') + 1;
  std::istringstream list(pattern.substr(begin, pattern.find(')') - begin));
  for (std::string word; std::getline(list, word, '|');) known.insert(word);
  BOOST_TEST((allowed_by(refusal_of("scene = 'zzzzzzzz'")) == known));
  for (const std::string& word : known) BOOST_TEST(refusal_of("scene = ['" + word + "', '!" + word + "']") == "");
}

BOOST_AUTO_TEST_CASE(every_family_of_the_suite_is_valid_and_broken_ones_are_not,
                     *boost::unit_test::enable_if<RIGOR_HTML_REPORT>()) {
  Json valid = Json::object();
  for (const auto& folder : fs::directory_iterator(default_suite_dir())) {
    const fs::path file = folder.path() / kFamilyFile;
    if (fs::exists(file)) valid[file.string()] = test::as_json(toml::parse_file(file.string()));
  }
  BOOST_TEST(valid.size() > 1u);
  const Json gate = {{"metric", "cost"}, {"max", 1}, {"because", "x"}};
  Json broken = Json::array({Json::object(), {{"gate", Json::array()}}, {{"title", "x"}, {"gate", {gate}}}});
  const Json wrong = {{"scene", "sprng"}, {"truth", "guess"}, {"except", 1}, {"colour", "red"}};
  for (const auto& [key, value] : wrong.items()) {
    Json one = gate;
    one[key] = value;
    broken.push_back({{"gate", {one}}});
    if (key != "except") BOOST_TEST(refusal_of(key + " = '" + value.get<std::string>() + "'") != "", key);
  }
  test::check_by_ajv(kSchema, valid, broken);
}

BOOST_AUTO_TEST_SUITE_END()
