#include "cases/report/json/leave_out_details.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "cases/results/result_json.h"

namespace rigor {
namespace {

using Json = nlohmann::ordered_json;

// And what nobody asked for, which is not what does not apply.
void keep_values(Json& metrics) {
  Json kept = Json::object();
  for (const auto& [name, metric] : metrics.items()) {
    if (metric.contains("value")) {
      kept[name] = {{"value", metric.at("value")}};
    } else if (metric.at("not_applicable").get<std::string>().starts_with("not measured")) {
      kept[name] = metric;
    }
  }
  metrics = kept;
}

void drop_text_of_held(Json& answers) {
  for (Json& answer : answers) {
    if (answer.at("answer") == "held") answer.erase("text");
  }
}

void shorten_cells(Json& cells) {
  std::map<std::string, std::size_t> told;  // by settings: the place of the first cell with them
  for (std::size_t place = 0; place < cells.size(); ++place) {
    Json& cell = cells[place];
    keep_values(cell.at("metrics"));
    if (Json& scheme = cell.at("by_scheme"); !scheme.is_null()) {
      keep_values(scheme.at("metrics"));
      keep_values(scheme.at("without_gyroscopic_term"));
    }
    drop_text_of_held(cell.at("gates"));
    if (cell.at("settings").empty()) continue;
    const auto [first, is_new] = told.try_emplace(text_of(cell.at("settings"), -1), place);
    if (!is_new) cell["settings"] = Json::object(), cell["settings_of"] = first->second;
  }
}

}  // namespace

void leave_out_details(Json& results) {
  shorten_cells(results.at("cells"));
  for (Json& one : results.at("cases")) {
    one.at("spread").clear();
    for (Json& order : one.at("observed_order")) order.erase("errors"), order.erase("not_applicable");
    for (Json& gate : one.at("gates")) drop_text_of_held(gate.at("answers"));
  }
}

}  // namespace rigor
