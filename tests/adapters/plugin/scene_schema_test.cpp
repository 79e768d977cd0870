// scene.schema.json, by which engines from outside read scenes, has the joints and shapes of the tables.
#include <boost/test/unit_test.hpp>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/scene/joint_types.h"
#include "core/scene/shape_types.h"
#include "generated/tests/places.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_plugin_scene_schema)
using Words = std::set<std::string>;

namespace {

nlohmann::json definitions() {
  std::ifstream file(RIGOR_SOURCE_DIR "/adapters/plugin/scene.schema.json");
  return nlohmann::json::parse(file).at("definitions");
}

// The keys that each variant requires, by its word. `shared` are keys that are no fields of the type.
std::map<std::string, Words> fields_by_word(const nlohmann::json& variants, const Words& shared) {
  std::map<std::string, Words> fields;
  for (const nlohmann::json& variant : variants) {
    if (!variant.contains("properties")) continue;
    Words& own = fields[variant.at("properties").at("type").at("const")];
    for (const std::string key : variant.at("required")) {
      if (!shared.contains(key)) own.insert(key);
    }
  }
  return fields;
}

template <typename Rows>
std::map<std::string, Words> fields_of_table(const Rows& rows) {
  std::map<std::string, Words> fields;
  for (const auto& row : rows) fields[row.word] = Words(row.keys.begin(), row.keys.end());
  return fields;
}

}  // namespace

BOOST_AUTO_TEST_CASE(has_the_joint_types_of_the_table_with_their_vectors) {
  const Words shared = {"type", "a", "b", "stiffness", "damping", "axes"};
  const auto in_schema = fields_by_word(definitions().at("joint").at("oneOf"), shared);
  auto in_table = fields_of_table(joint_types());
  in_table.erase("compound-axis");  // it is written among the axes of its compound joint
  BOOST_TEST((in_schema == in_table));
}

// Points, triangles and heights are no fields of the descriptors. Parts of a compound stand in a list of their own,
// `shapes`.
BOOST_AUTO_TEST_CASE(has_the_shapes_of_the_table_with_their_fields) {
  auto in_schema = fields_by_word(definitions().at("solid").at("oneOf"), {"type", "points"});
  in_schema.merge(fields_by_word(definitions().at("shape").at("oneOf"), {"type"}));
  in_schema.at("mesh") = in_schema.at("heightfield") = {};
  auto in_table = fields_of_table(shape_types());
  in_table.erase("compound");
  BOOST_TEST((in_schema == in_table));
}

BOOST_AUTO_TEST_SUITE_END()
