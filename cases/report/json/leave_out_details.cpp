#include "cases/report/json/leave_out_details.h"

#include <map>
#include <set>
#include <string>

#include "cases/results/result_json.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

// Includes metrics that nobody requested, which differ from those that do not apply.
void keep_values(Json& metrics) {
  Json kept = Json::object();
  for (const auto& [name, metric] : metrics.items()) {
    if (metric.contains("value")) {
      kept[name] = {{"value", metric.at("value")}};
      if (metric.contains("held_to_itself")) kept[name]["held_to_itself"] = metric.at("held_to_itself");
    } else if (metric.at("not_applicable").get<std::string>().starts_with("not measured")) {
      kept[name] = {{"not_applicable", "not measured"}};
    }
  }
  metrics = kept;
}

// The answer of a held bound for one cell is its metric's value, which the cell already has. For a regression it is the
// recorded value.
void shorten_answers(Json& gate) {
  const bool is_bound = gate.at("kind") == "bound";
  for (Json& answer : gate.at("answers")) {
    if (answer.at("caveat") == "") answer.erase("caveat");
    if (answer.at("answer") != "held") continue;
    answer.erase("text");
    if (is_bound && answer.at("dt") != "") answer.erase("value");
  }
}

// A gate asks one thing or two of seven.
Json without_nulls(const Json& gate) {
  Json kept = Json::object();
  for (const auto& [key, value] : gate.items()) {
    if (!value.is_null()) kept[key] = value;
  }
  return kept;
}

// The metrics by case that no cell measured, because nobody requested them.
std::map<std::string, std::set<std::string>> unmeasured_in(const Json& cells) {
  std::map<std::string, std::set<std::string>> found;
  for (const Json& cell : cells) {
    std::set<std::string> own;
    for (const auto& [name, metric] : cell.at("metrics").items()) {
      if (!metric.contains("value")) own.insert(name);
    }
    if (cell.at("metrics").empty()) continue;
    auto& of_case = found.try_emplace(cell.at("case").get<std::string>(), own).first->second;
    std::erase_if(of_case, [&](const std::string& name) { return !own.contains(name); });
  }
  return found;
}

void gather_unmeasured(Json& results) {
  const auto unmeasured = unmeasured_in(results.at("cells"));
  for (Json& cell : results.at("cells")) {
    const auto found = unmeasured.find(cell.at("case").get<std::string>());
    if (found == unmeasured.end()) continue;
    for (const std::string& name : found->second) cell.at("metrics").erase(name);
  }
  for (Json& one : results.at("cases")) {
    const auto found = unmeasured.find(one.at("id").get<std::string>());
    if (found != unmeasured.end() && !found->second.empty()) one["not_measured"] = found->second;
  }
}

// Of a stable cell the reason goes: that nothing was found.
void shorten_verdict(Json& verdict) {
  if (!verdict.is_null() && verdict.at("word") == "stable") verdict["why"] = "";
}

template <typename F>
void drop_rows_that(const F& say_nothing, Json& rows) {
  Json kept = Json::array();
  for (const Json& row : rows) {
    if (!say_nothing(row)) kept.push_back(row);
  }
  rows = kept;
}

void shorten_cells(Json& cells) {
  std::map<std::string, std::size_t> told;  // by settings: the place of the first cell with them
  for (std::size_t place = 0; place < cells.size(); ++place) {
    Json& cell = cells[place];
    keep_values(cell.at("metrics"));
    if (Json& scheme = cell.at("by_scheme"); !scheme.is_null())
      scheme.at("metrics").clear(), scheme.at("without_gyroscopic_term").clear();
    shorten_verdict(cell.at("verdict"));
    for (Json& answer : cell.at("gates")) answer.erase("text");
    if (cell.at("settings").empty()) continue;
    const auto [first, is_new] = told.try_emplace(text_of(cell.at("settings"), -1), place);
    if (!is_new) cell["settings"] = Json::object(), cell["settings_of"] = first->second;
  }
}

}  // namespace

void leave_out_details(Json& results) {
  shorten_cells(results.at("cells"));
  gather_unmeasured(results);
  drop_rows_that([](const Json& row) { return row.at("reason") == word_of(SkipReason::not_asked_for); },
                 results.at("stable_dt"));
  for (Json& one : results.at("cases")) {
    one.at("spread").clear(), one.at("own_steps").clear();
    one.at("explanation_claims").clear();
    drop_rows_that([](const Json& order) { return order.at("value").is_null(); }, one.at("observed_order"));
    for (Json& order : one.at("observed_order")) order.erase("errors");
    for (Json& gate : one.at("gates")) {
      shorten_answers(gate);
      gate = without_nulls(gate);
    }
  }
}

}  // namespace rigor::inline report
