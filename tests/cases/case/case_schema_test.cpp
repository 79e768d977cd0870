// Compares case.schema.json, which editors use for completion, with the reader. The reader lists allowed keys and words
// in its errors, so an addition to the reader alone is noticed here.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cases/case/case_reader.h"
#include "cases/case/suite.h"
#include "core/base/error.h"
#include "tests/cases/case/schema.h"
#include "tests/cases/vocabulary.h"
#include "tests/folder.h"

using namespace rigor;
using test::Json;

BOOST_AUTO_TEST_SUITE(cases_case_case_schema)
using Words = std::set<std::string>;

namespace {

const std::string kSchema = RIGOR_SOURCE_DIR "/cases/case/case.schema.json";
constexpr const char* kUnknown = "zzzzzzzz";  // like no word of ours

const Json& schema() {
  static const Json all = Json::parse(test::content(kSchema));
  return all;
}

const Json& resolved(const Json& part) {
  if (!part.contains("$ref")) return part;
  return resolved(schema().at(Json::json_pointer(part.at("$ref").get<std::string>().substr(1))));
}

// A table's own variants: a shape's, a joint's; else it is the only one.
std::vector<Json> variants_of(const Json& table) {
  std::vector<Json> variants;
  for (const Json& one : table.value("oneOf", Json::array()))
    if (one.contains("properties")) variants.push_back(one);
  if (variants.empty()) variants.push_back(table);
  return variants;
}

Words keys_of(const Json& variant) {
  Words keys;
  for (const auto& [key, value] : variant.at("properties").items()) keys.insert(key);
  return keys;
}

Words keys_of(const std::vector<Json>& variants) {
  Words keys;
  for (const Json& variant : variants) keys.merge(keys_of(variant));
  return keys;
}

// A value that the reader takes for this key, of whatever table.
Json sample_of(const std::string& key) {
  static const Json samples = Json::parse(R"({"a": "world", "b": "a", "anchor": [0, 0, 0], "axis": [0, 0, 1],
    "axis2": [1, 0, 0], "point_a": [0, 0, 0], "point_b": [0, 0, 1], "size": [1, 1, 1], "radius": 1, "length": 1,
    "normal": [0, 0, 1], "offset": 0, "radii": [1, 1, 1]})");
  return samples.value(key, Json(1));
}

Json whole_case() {
  return Json::parse(R"({"title": "t",
    "scene": {"body": [{"name": "a", "mass": 1, "inertia": [1, 1, 1]}]},
    "run": {"duration": 1, "dt": 0.1}})");
}

// JSON as TOML: a line for each key of the root, all else inline.
std::string as_toml(const Json& value) {
  if (!value.is_object() && !value.is_array()) return value.dump();
  std::string items;
  for (const auto& [key, item] : value.items())
    items += (items.empty() ? "" : ", ") + (value.is_object() ? key + " = " : "") + as_toml(item);
  return value.is_object() ? "{" + items + "}" : "[" + items + "]";
}

// The words that the reader allows in place of what it refuses in this case; none if it takes it or allows no words.
Words allowed_by_reader(const Json& of_case) {
  std::string text;
  for (const auto& [key, value] : of_case.items()) text += key + " = " + as_toml(value) + "\n";
  const Folder folder;
  try {
    read_case(folder.write("case.toml", text), "case", test::words());
  } catch (const InputError& error) {
    const std::string said = error.what();
    const std::size_t at = said.rfind("; allowed: ");
    BOOST_TEST_INFO(said);
    BOOST_REQUIRE(at != std::string::npos);
    std::istringstream list(said.substr(at + std::string("; allowed: ").size()));
    Words words;
    for (std::string word; std::getline(list >> std::ws, word, ',');) words.insert(word);
    return words;
  }
  return {};
}

// Where a table of the schema stands in a case: its keys from the root on.
using Path = std::vector<std::string>;

// A case with this table in that place: the first of an array, beside the keys that are there already.
Json case_with(const Path& path, const Json& table) {
  Json out = whole_case();
  Json* place = &out;
  for (const std::string& key : path) {
    const bool is_array = key.ends_with("[]");
    place = &(*place)[is_array ? key.substr(0, key.size() - 2) : key];
    if (is_array) place = &(*place)[0];
    // Axes stand in a compound joint alone, which needs its bodies.
    if (key == "joint[]" && path.back() != key) *place = {{"type", "compound"}, {"a", "world"}, {"b", "a"}};
  }
  for (const auto& [key, value] : table.items()) (*place)[key] = value;
  return out;
}

// Calls see(path, table) for each table of the schema.
template <typename F>
void for_tables(const Json& part, const Path& path, F see) {
  const Json& table = resolved(part);
  if (table.value("type", "") == "array") {
    Path below = path;
    below.back() += "[]";
    if (table.contains("items")) for_tables(table.at("items"), below, see);
    return;
  }
  if (table.value("type", "") != "object") return;
  see(path, table);
  for (const Json& variant : variants_of(table)) {
    for (const auto& [key, value] : variant.at("properties").items()) {
      Path below = path;
      below.push_back(key);
      for_tables(value, below, see);
    }
  }
}

std::string shown(const Path& path) {
  std::string all = "case";
  for (const std::string& key : path) all += "." + key;
  return all;
}

void check_same(const Words& in_schema, const Words& in_reader) {
  BOOST_CHECK_EQUAL_COLLECTIONS(in_schema.begin(), in_schema.end(), in_reader.begin(), in_reader.end());
}

}  // namespace

BOOST_AUTO_TEST_CASE(has_the_keys_of_the_reader_and_no_others) {
  int tables = 0;
  for_tables(schema(), {}, [&](const Path& path, const Json& table) {
    BOOST_TEST_CONTEXT(shown(path) << " in case.schema.json (left) and in the reader (right)") {
      check_same(keys_of(variants_of(table)), allowed_by_reader(case_with(path, {{kUnknown, 1}})));
    }
    ++tables;
  });
  BOOST_TEST(tables > 5);  // the walk found the scene, the run, the truth, a gate, a body, ...
}

BOOST_AUTO_TEST_CASE(has_the_keys_of_each_kind_of_shape_and_joint) {
  int kinds = 0;
  for_tables(schema(), {}, [&](const Path& path, const Json& table) {
    const std::vector<Json> variants = variants_of(table);
    const Words all = keys_of(variants);
    for (const Json& variant : variants) {
      if (!variant.at("properties").contains("type") || variants.size() < 2) continue;
      const std::string type = variant.at("properties").at("type").at("const");
      const Words own = keys_of(variant);
      for (const std::string& key : all) {
        if (own.contains(key)) continue;
        BOOST_TEST_CONTEXT(shown(path) << " of type " << type << " in case.schema.json (left) and in the reader") {
          Json kind = {{"type", type}, {key, sample_of(key)}};
          for (const std::string needed : variant.at("required"))
            if (needed != "type") kind[needed] = sample_of(needed);
          check_same(own, allowed_by_reader(case_with(path, kind)));
        }
        ++kinds;
        break;
      }
    }
  });
  BOOST_TEST(kinds > 5);
}

BOOST_AUTO_TEST_CASE(has_the_words_of_the_reader_and_no_others) {
  int choices = 0;
  for_tables(schema(), {}, [&](const Path& path, const Json& table) {
    std::map<std::string, Words> words_of;
    for (const Json& variant : variants_of(table)) {
      for (const auto& [key, value] : variant.at("properties").items()) {
        const Json& rule = resolved(value.contains("anyOf") ? value.at("anyOf").at(0) : value);
        for (const Json& word : rule.value("enum", Json::array())) words_of[key].insert(word);
        if (rule.contains("const")) words_of[key].insert(rule.at("const").get<std::string>());
      }
    }
    const Words keys = keys_of(variants_of(table));
    for (const auto& [key, words] : words_of) {
      Json with_unknown = {{key, kUnknown}};
      for (const std::string end : {"a", "b"})  // are read before a joint's type
        if (keys.contains(end)) with_unknown[end] = sample_of(end);
      BOOST_TEST_CONTEXT(shown(path) << "." << key << " in case.schema.json (left) and in the reader (right)") {
        check_same(words, allowed_by_reader(case_with(path, with_unknown)));
      }
      ++choices;
    }
  });
  BOOST_TEST(choices > 3);  // a joint's and a shape's type, a truth's kind, a gate's metric
}

namespace {

// Cases that the reader refuses, and an editor should underline.
Json broken_cases() {
  Json broken = Json::array();
  const auto add = [&](const char* path, const char* value) {
    Json one = whole_case();
    one[Json::json_pointer(path)] = Json::parse(value);
    broken.push_back(one);
  };
  add("/title", "\"\"");
  add("/scene/body", "[]");
  add("/scene/body/0/mass", "0");
  add("/scene/body/0/inertia", "[1, 1, 1, 1]");
  add("/scene/body/0/colour", "\"red\"");
  add("/scene/body/0/shape", R"({"type": "ball", "radius": 1})");
  add("/scene/body/0/shape", R"({"type": "sphere", "radius": 1, "length": 1})");
  add("/scene/joint", R"([{"type": "hinge", "a": "world", "b": "a", "anchor": [0, 0, 0]}])");
  add("/scene/force", R"([{"body": "a"}])");
  add("/scene/contact_default", R"({"restitution": 1.5})");
  add("/run/dt", "[]");
  add("/truth", R"({"kind": "guess"})");
  add("/gate", R"([{"metric": "position_error", "max": 1}])");
  add("/gate", R"([{"metric": "prettiness", "max": 1, "because": "it is"}])");
  return broken;
}

}  // namespace

// Uses ajv, which comes with the HTML report's page.
BOOST_AUTO_TEST_CASE(every_case_of_the_suite_is_valid_and_broken_ones_are_not,
                     *boost::unit_test::enable_if<RIGOR_HTML_REPORT>()) {
  Json valid = Json::object();
  for (const Case& one : select_cases({}, default_suite_dir(), test::words()))
    valid[one.id] = test::as_json(toml::parse(one.text));
  for (const Json& one : broken_cases()) {
    std::string text;
    for (const auto& [key, value] : one.items()) text += key + " = " + as_toml(value) + "\n";
    const Folder folder;
    BOOST_TEST_CONTEXT(text) {
      BOOST_CHECK_THROW(read_case(folder.write("case.toml", text), "case", test::words()), InputError);
    }
  }
  test::check_by_ajv(kSchema, valid, broken_cases());
}

BOOST_AUTO_TEST_SUITE_END()
