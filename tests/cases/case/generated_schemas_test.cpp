// The JSON Schemas have the words and keys of the tables: metrics, truths, features, shapes, joints and statuses. This
// test writes each schema as the tables have it. Texts that the tables do not know, such as descriptions, stay as they
// are.
#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include "cases/case/gate_reader.h"
#include "cases/metrics/verdict.h"
#include "cases/results/results.h"
#include "core/scene/joint_types.h"
#include "core/scene/shape_types.h"
#include "generated/tests/places.h"
#include "tests/cases/case/schema.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;
using test::Json;

BOOST_AUTO_TEST_SUITE(cases_case_generated_schemas)

namespace {

const std::string kSources = RIGOR_SOURCE_DIR "/", kFound = RIGOR_BUILD_DIR "/tests/schemas/";
const std::string kCase = "cases/case/case.schema.json", kFamily = "cases/case/family.schema.json",
                  kScene = "adapters/plugin/scene.schema.json", kResults = "cases/report/json/results.schema.json";

Json read(const std::string& schema) { return Json::parse(test::content(kSources + schema)); }

// An object that fits into a line of 150 characters stands in one; words fill their lines.
std::string as_text(const Json& value, std::size_t indent = 0, std::size_t key = 0) {
  std::vector<std::string> items;
  for (const auto& [name, item] : value.items()) {
    const std::string start = value.is_object() ? Json(name).dump() + ": " : "";
    items.push_back(start + (item.is_structured() ? as_text(item, indent + 2, start.size()) : item.dump()));
  }
  if (items.empty()) return value.dump();
  const char open = value.is_object() ? '{' : '[', close = value.is_object() ? '}' : ']';
  const std::string line = fmt::format("{}", fmt::join(items, ", "));
  if (line.find('\n') == std::string::npos && indent + key + line.size() < 146)
    return value.is_object() ? fmt::format("{{ {} }}", line) : fmt::format("[{}]", line);
  const std::string margin(indent + 2, ' ');
  const bool are_words = value.is_array() && !value.front().is_structured();
  std::string text(1, open);
  std::size_t used = std::string::npos;  // of the line: the first item begins one
  for (std::size_t i = 0; i < items.size(); ++i) {
    const bool goes_on = are_words && used != std::string::npos && used + items[i].size() < 146;
    text += goes_on ? " " : "\n" + margin;
    used = (goes_on ? used + 1 : margin.size()) + items[i].size() + 1;
    text += items[i] + (i + 1 < items.size() ? "," : "");
  }
  return text + "\n" + std::string(indent, ' ') + close;
}

Json ref(const std::string& definition) { return {{"$ref", "#/definitions/" + definition}}; }

Json described(Json rule, const std::string& text) {
  rule["description"] = text;
  return rule;
}

bool has_word(const Json& variant, const std::string& word) {
  const Json type = variant.value(Json::json_pointer("/properties/type"), Json::object());
  if (type.value("const", "") == word) return true;
  for (const Json& one : type.value("enum", Json::array()))
    if (one == word) return true;
  return false;
}

// Required keys that the tables do not know, for readers of their own read them.
bool is_read_apart(const std::string& word, const std::string& key) {
  static const std::map<std::string, std::vector<std::string>> kKeys = {
      {"compound", {"axes", "parts"}},     {"convex", {"points", "triangles"}},
      {"hinge", {"damping", "stiffness"}}, {"heightfield", {"heights", "points", "size", "triangles"}},
      {"mesh", {"points", "triangles"}},   {"slider", {"damping", "stiffness"}}};
  const auto row = kKeys.find(word);
  return row != kKeys.end() && std::find(row->second.begin(), row->second.end(), key) != row->second.end();
}

void require(Json& variant, const std::string& key) {
  Json& required = variant["required"];
  if (std::find(required.begin(), required.end(), key) == required.end()) required.push_back(key);
}

// The variant of this word with its own copy of the rules, or else `fresh`. It requires the keys of `fresh`, those of
// the table, and those that are read apart.
Json variant_of(const Json& variants, const std::string& word, const Json& fresh,
                const std::vector<std::string>& keys) {
  Json made = fresh;
  for (const Json& variant : variants)
    if (has_word(variant, word)) made = variant;
  const Json before = made["required"];
  made["required"] = fresh.at("required");
  for (const std::string& key : keys) require(made, key);
  for (const std::string key : before)
    if (is_read_apart(word, key)) require(made, key);
  made["properties"]["type"] = {{"const", word}};
  return made;
}

// A key that has a rule keeps it.
void add_key(Json& variant, const std::string& key, const Json& rule) {
  if (!variant["properties"].contains(key)) variant["properties"][key] = rule;
}

Json rule_of(ShapeQuantity quantity) {
  switch (quantity) {
    case ShapeQuantity::length:
      return described(ref("positive"), "m");
    case ShapeQuantity::lengths:
      return described(ref("vector"), "m, along x, y and z; each greater than 0.");
    case ShapeQuantity::direction:
      return described(ref("vector"), "In W.");
    case ShapeQuantity::number:
      break;
  }
  return {{"type", "number"}, {"description", "m"}};
}

// Calls add(row, variant) for each of the shapes, and makes the list of variants anew.
template <typename Takes, typename Add>
Json shapes_of(const Json& old, const Json& fresh, const Takes& takes, const Add& add) {
  Json variants = Json::array();
  for (const ShapeInfo& row : shape_types()) {
    if (!takes(row)) continue;
    Json variant = variant_of(old, row.word, fresh, row.keys);
    add(row, variant);
    variants.push_back(variant);
  }
  return variants;
}

void add_fields(const ShapeInfo& row, Json& variant) {
  for_each_field(row.prototype, [&](const char* key, ShapeQuantity quantity, const auto&) {
    add_key(variant, key, rule_of(quantity));
  });
}

bool is_compound(const ShapeInfo& row) { return std::holds_alternative<Compound>(row.prototype); }

template <typename RuleOf>
Json joints_of(const Json& old, Json fresh, const RuleOf& rule_of_vector) {
  for (const char* end : {"a", "b"}) require(fresh, end);
  Json variants = Json::array();
  for (const JointTypeInfo& row : joint_types()) {
    if (!row.is_whole) continue;
    Json variant = variant_of(old, row.word, fresh, row.keys);
    for_each_vector(row.prototype, [&](const char* key, JointVector kind, const Vec3&) {
      add_key(variant, key, rule_of_vector(kind));
    });
    for_each_number(row.prototype, [&](const char* key, double) { add_key(variant, key, {{"type", "number"}}); });
    variants.push_back(variant);
  }
  return variants;
}

Json truth_words() {
  Json words = test::words().truths;
  words.push_back("none");
  return words;
}

Json case_schema() {
  Json schema = read(kCase);
  Json& parts = schema["definitions"];
  Json metrics = test::words().metrics;
  for (const std::string& across : test::words().cross_metrics) metrics.push_back(across);
  parts["metric"]["enum"] = metrics;
  parts["truth"]["properties"]["kind"]["enum"] = truth_words();
  const Json shape = {{"description", ""}, {"additionalProperties", false}, {"required", {"type"}}};
  parts["shape"]["oneOf"] =
      shapes_of(parts["shape"]["oneOf"], shape, std::not_fn(is_compound), [&](const ShapeInfo& row, Json& variant) {
        if (variant["description"] == "") variant["description"] = row.meaning;
        add_fields(row, variant);
        if (!row.is_solid) return;
        add_key(variant, "position", described(ref("vector"), "m, in the body's frame B; default 0."));
        add_key(variant, "orientation_wxyz", ref("shape_turn"));
      });
  const Json joint = {{"additionalProperties", false},
                      {"required", {"type"}},
                      {"properties", {{"type", ""}, {"name", ref("text")}, {"a", ref("end")}, {"b", ref("end")}}}};
  parts["joint"]["oneOf"] = joints_of(parts["joint"]["oneOf"], joint, [](JointVector kind) {
    return ref(kind == JointVector::point ? "anchor" : kind == JointVector::direction ? "axis" : "point");
  });
  return schema;
}

Json family_schema() {
  Json schema = read(kFamily);
  Json& parts = schema["definitions"];
  const Json of_case = case_schema()["definitions"];
  for (auto& [name, rule] : parts.items())
    if (name != "gate" && of_case.contains(name)) rule = of_case[name];
  parts["gate"]["required"] = of_case["gate"]["required"];
  for (const auto& [key, rule] : of_case["gate"]["properties"].items()) parts["gate"]["properties"][key] = rule;
  parts["truth_kind"]["enum"] = truth_words();
  parts["scene_word"]["pattern"] = fmt::format("^!?({})(:|$)", fmt::join(known_scene_words(), "|"));
  return schema;
}

// Anchors, axes and points are vectors.
Json scene_schema() {
  Json schema = read(kScene);
  Json& parts = schema["definitions"];
  const Json shape = {{"type", "object"}, {"required", {"type"}}};
  parts["solid"]["oneOf"] = shapes_of(
      parts["solid"]["oneOf"], shape, [](const ShapeInfo& row) { return row.is_solid; }, add_fields);
  const auto stands = [](const ShapeInfo& row) { return row.stands_still; };
  const Json others = shapes_of(parts["shape"]["oneOf"], shape, stands, add_fields);
  parts["shape"]["oneOf"] = Json::array({ref("solid")});
  for (const Json& other : others) parts["shape"]["oneOf"].push_back(other);
  const Json name = {{"type", "string"}, {"minLength", 1}};
  const Json joint = {{"type", "object"},
                      {"required", {"type"}},
                      {"properties", {{"type", ""}, {"name", name}, {"a", name}, {"b", name}}}};
  parts["joint"]["oneOf"] = joints_of(parts["joint"]["oneOf"], joint, [](JointVector) { return ref("vector"); });
  return schema;
}

template <typename Enum>
Json words_until(Enum last) {
  Json words = Json::array();
  for (int i = 0; i <= static_cast<int>(last); ++i) words.push_back(word_of(static_cast<Enum>(i)));
  return words;
}

Json results_schema() {
  Json schema = read(kResults);
  schema["definitions"]["status"]["enum"] = words_until(Status::invalid);
  schema[Json::json_pointer("/definitions/cell/properties/verdict/oneOf/1/properties/word/enum")] =
      words_until(Verdict::blown_up);
  Json& shapes = schema[Json::json_pointer("/definitions/scene/properties/bodies/items/properties/shape/oneOf")];
  const Json shape = {{"type", "object"}, {"required", {"type"}}};
  const auto every = [](const ShapeInfo&) { return true; };
  const Json variants = shapes_of(shapes, shape, every, [](const ShapeInfo&, Json&) {});
  shapes = Json::array({{{"type", "null"}}});  // a body without a shape
  for (const Json& variant : variants) shapes.push_back(variant);
  return schema;
}

}  // namespace

BOOST_AUTO_TEST_CASE(has_each_schema_as_the_tables_have_it) {
  const std::map<std::string, Json> schemas = {
      {kCase, case_schema()}, {kFamily, family_schema()}, {kScene, scene_schema()}, {kResults, results_schema()}};
  for (const auto& [file, schema] : schemas) {
    const std::filesystem::path found = kFound + file;
    std::filesystem::create_directories(found.parent_path());
    std::ofstream(found) << as_text(schema) << '\n';
    BOOST_TEST((test::content(kSources + file) == test::content(found.string())),
               file << " is not as the tables have it. Look at the difference, then: cp " << found.string() << ' '
                    << kSources + file);
  }
}

BOOST_AUTO_TEST_SUITE_END()
