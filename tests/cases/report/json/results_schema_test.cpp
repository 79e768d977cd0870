// Each list of words in results.schema.json equals the table that writes these words.
#include <boost/test/unit_test.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "cases/metrics/verdict.h"
#include "cases/results/results.h"
#include "core/scene/shape_types.h"
#include "generated/tests/places.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_json_results_schema)
using Json = nlohmann::ordered_json;
using Words = std::set<std::string>;

namespace {

const Json& results_schema() {
  static const Json all = [] {
    std::ifstream file(RIGOR_SOURCE_DIR "/cases/report/json/results.schema.json");
    return Json::parse(file);
  }();
  return all;
}

const Json& at(const char* pointer) { return results_schema().at(Json::json_pointer(pointer)); }

// The words of an enum; of a const, the one.
Words words_of(const Json& rule) {
  Words words;
  for (const Json& word : rule.value("enum", Json::array())) words.insert(word);
  if (rule.contains("const")) words.insert(rule.at("const").get<std::string>());
  return words;
}

template <typename Enum>
Words words_until(Enum last) {
  Words words;
  for (int i = 0; i <= static_cast<int>(last); ++i) words.insert(word_of(static_cast<Enum>(i)));
  return words;
}

void check_equal(const Words& in_schema, const Words& in_table) {
  BOOST_CHECK_EQUAL_COLLECTIONS(in_schema.begin(), in_schema.end(), in_table.begin(), in_table.end());
}

}  // namespace

BOOST_AUTO_TEST_CASE(has_the_statuses_and_verdicts_of_the_tables) {
  check_equal(words_of(at("/definitions/status")), words_until(Status::invalid));
  check_equal(words_of(at("/definitions/cell/properties/verdict/oneOf/1/properties/word")),
              words_until(Verdict::blown_up));
}

BOOST_AUTO_TEST_CASE(has_the_shapes_of_the_table_with_their_fields) {
  Words in_schema, in_table;
  for (const ShapeInfo& shape : shape_types()) in_table.insert(shape.word);
  for (const Json& variant : at("/definitions/scene/properties/bodies/items/properties/shape/oneOf")) {
    if (!variant.contains("properties")) continue;  // null: a body without a shape
    for (const std::string& word : words_of(variant.at("properties").at("type"))) {
      in_schema.insert(word);
      for (const ShapeInfo& shape : shape_types()) {
        if (shape.word != word) continue;
        Words required = variant.at("required").get<Words>(), fields(shape.keys.begin(), shape.keys.end());
        for (const char* made : {"type", "parts", "points", "triangles"}) required.erase(made), fields.erase(made);
        BOOST_TEST_CONTEXT(word) check_equal(required, fields);
      }
    }
  }
  check_equal(in_schema, in_table);
}

BOOST_AUTO_TEST_SUITE_END()
