#include "cases/report/json/frontier_json.h"

#include <cmath>
#include <set>
#include <string>

#include "cases/analysis/frontier.h"
#include "cases/report/wording/recommendation.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

// A percentile that lies among failed cases is infinite: null.
Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json_of(const FrontierPoint& point) {
  return {{"dt", point.dt.text},
          {"dt_seconds", point.dt.seconds},
          {"cases", point.cases},
          {"failed", point.failed},
          {"mean", finite_or_null(point.mean)},
          {"median", finite_or_null(point.median)},
          {"low", finite_or_null(point.low)},
          {"high", finite_or_null(point.high)},
          {"cost", point.cost}};
}

Json scope_json(const Results& results, const std::string& family) {
  Json curves = Json::array();
  for (const Frontier& frontier : frontiers(results, family)) {
    Json points = Json::array();
    for (const FrontierPoint& point : frontier.points) points.push_back(json_of(point));
    curves.push_back({{"engine", results.runs[frontier.run].text},
                      {"reference", frontier.is_reference},
                      {"unsupported", frontier.unsupported},
                      {"points", points}});
  }
  return {{"family", family}, {"curves", curves}};
}

std::set<std::string> families(const Results& results) {
  std::set<std::string> found;
  for (const CaseResult& result : results.cases) {
    const std::size_t slash = result.definition.id.rfind('/');
    if (slash != std::string::npos) found.insert(result.definition.id.substr(0, slash));
  }
  return found;
}

}  // namespace

Json frontier_json(const Results& results) {
  Json scopes = Json::array({scope_json(results, "")});
  const std::set<std::string> found = families(results);
  if (found.size() < 2) return scopes;
  for (const std::string& family : found) scopes.push_back(scope_json(results, family));
  return scopes;
}

Json recommendation_json(const Results& results) {
  const std::vector<Frontier> all = nothing_moves(results) ? std::vector<Frontier>() : frontiers(results);
  Json json = {{"tolerance", kRecommendedTolerance}};
  const std::pair<const char*, Candidates> kinds[] = {
      {"external", Candidates::engines}, {"core", Candidates::core_methods}, {"reference", Candidates::references}};
  for (const auto& [key, candidates] : kinds) {
    const std::optional<Choice> choice = cheapest_within(results, all, kRecommendedTolerance, candidates);
    json[key] = nullptr;
    if (!choice) continue;
    json[key] = json_of(choice->point);
    json[key]["engine"] = results.runs[choice->run].text;
    json[key]["unsupported"] = choice->unsupported;
  }
  return json;
}

}  // namespace rigor::inline report
