#include "cases/report/json/comparison_json.h"

#include "cases/analysis/work_precision.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

Json json_of(const Furthest& furthest, const Scene& scene) {
  return {{"value", furthest.value}, {"time", furthest.time}, {"body", scene.body_name(furthest.body)}};
}

}  // namespace

Json observed_orders_json(const Results& results, const CaseResult& result) {
  Json orders = Json::array();
  for (const std::string& metric : errors_worth_comparing(result)) {
    for (std::size_t run = 0; run < results.runs.size(); ++run) {
      const ObservedOrder order = observed_order(result, run, metric);
      Json json = {{"engine", results.runs[run].text}, {"metric", metric}};
      json["value"] = order.value ? Json(*order.value) : Json(nullptr);
      json[order.value ? "errors" : "not_applicable"] = order.text;
      orders.push_back(json);
    }
  }
  return orders;
}

// Of each run at a step with itself at its finest.
Json own_steps_json(const Results& results, const CaseResult& result) {
  Json own = Json::array();
  for (const Spread& spread : result.spreads) {
    if (!spread.is_own_step()) continue;
    own.push_back({{"run", results.runs[spread.first].text},
                   {"dt", spread.dt.text},
                   {"distance", json_of(spread.distance, result.definition.scene)},
                   {"angle", json_of(spread.angle, result.definition.scene)},
                   {"compared_until", spread.compared_until}});
  }
  return own;
}

Json spreads_json(const Results& results, const CaseResult& result) {
  Json spreads = Json::array();
  for (const Spread& spread : result.spreads) {
    if (spread.is_own_step()) continue;
    spreads.push_back({{"first", results.runs[spread.first].text},
                       {"second", results.runs[spread.second].text},
                       {"dt", spread.dt.text},
                       {"distance", json_of(spread.distance, result.definition.scene)},
                       {"angle", json_of(spread.angle, result.definition.scene)},
                       {"parted_at", spread.parted_at ? Json(*spread.parted_at) : Json(nullptr)},
                       {"compared_until", spread.compared_until}});
  }
  return spreads;
}

Json work_precision_json(const Results& results, const CaseResult& result) {
  Json tables = Json::array();
  for (const std::string& metric : errors_worth_comparing(result)) {
    Json points = Json::array(), equal = Json::array(), best_ones = Json::array();
    for (std::size_t run = 0; run < results.runs.size(); ++run) {
      const std::string& name = results.runs[run].text;
      for (const ErrorPoint& point : error_points(result, run, metric)) {
        points.push_back({{"engine", name}, {"dt", point.dt.text}, {"cost", point.cost}, {"error", point.error}});
      }
      for (const std::size_t baseline : baselines(results)) {
        if (run == baseline) continue;
        for (const EqualCost& at : at_equal_cost(result, run, baseline, metric)) {
          if (!at.of_run) continue;
          equal.push_back({{"engine", name},
                           {"baseline", results.runs[baseline].text},
                           {"dt", at.of_baseline.dt.text},
                           {"cost", at.of_baseline.cost},
                           {"error", at.of_run->error},
                           {"times_less", at.times_less()},
                           {"reach", word_of(at.of_run->reach)}});
        }
      }
    }
    for (const std::size_t baseline : baselines(results)) {
      const auto best = best_of_core(results, result, baseline, metric);
      if (!best) continue;
      best_ones.push_back({{"baseline", results.runs[baseline].text},
                           {"engine", results.runs[best->points.front().run].text},
                           {"times_less", best->mean()},
                           {"times_less_at_worst", best->least()},
                           {"cells_compared", best->compared()},
                           {"cells", best->points.size()}});
    }
    tables.push_back({{"metric", metric}, {"points", points}, {"at_equal_cost", equal}, {"best_of_core", best_ones}});
  }
  return tables;
}

}  // namespace rigor::inline report
