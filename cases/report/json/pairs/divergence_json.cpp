#include "cases/report/json/pairs/divergence_json.h"

#include <cmath>

#include "core/base/json.h"

namespace rigor::inline report {
namespace {

Json json_of_bound(double bound) { return std::isfinite(bound) ? Json(bound) : Json(nullptr); }

Json json_of_run(const DivergingRun& run, const SettingsInForce& in_force, double spread) {
  Json settings = Json::object();
  for (const auto& [key, value] : in_force) settings[key] = value;
  return {{"run", run.name.text},
          {"dt", run.dt.text},
          {"settings", settings},
          {"deterministic", spread == 0},
          {"spread", spread}};
}

Json json_of_parting(const Divergence& found) {
  const Parting& parting = *found.parting;
  Json json = {{"time", parting.time},
               {"body", found.names[static_cast<std::size_t>(parting.body)]},
               {"component", parting.component},
               {"unit", parting.unit},
               {"gap", parting.gap},
               {"bound", parting.bound},
               {"part", parting.part},
               {"common_steps", parting.sample}};
  if (parting.in_a) json["a"] = *parting.in_a, json["b"] = *parting.in_b;
  return json;
}

Json json_of_injections(const Divergence& found) {
  Json steps = Json::array();
  for (const Injection& step : found.injections.steps)
    steps.push_back({{"time", step.time},
                     {"body", found.names[static_cast<std::size_t>(step.body)]},
                     {"share", step.share},
                     {"hidden_a", step.hidden_a},
                     {"hidden_b", step.hidden_b}});
  return {{"injected", found.injections.injected},
          {"growth", found.injections.growth},
          {"growth_factor", found.injections.growth_factor},
          {"all_steps", found.injections.has_all_steps},
          {"why", found.injections.why},
          {"steps", steps}};
}

Json json_of_cause(const Cause& cause, const Divergence& found) {
  Json evidence = Json::array();
  for (const Evidence& one : cause.evidence)
    evidence.push_back({{"part", one.what}, {"detail", one.detail}, {"share", one.share}});
  return {{"time", cause.at.time},
          {"body", found.names[static_cast<std::size_t>(cause.at.body)]},
          {"share", cause.at.share},
          {"part", cause.what},
          {"detail", cause.detail},
          {"explains", cause.share},
          {"at_half_step", cause.is_measured_at_half_step ? Json(cause.at_half_step) : Json(nullptr)},
          {"falls_with_dt", cause.falls_with_dt()},
          {"rounding", cause.is_rounding},
          {"why", cause.why},
          {"evidence", evidence}};
}

Json json_of_swap(const TriedSwap& swap) {
  Json names = Json::array();
  for (const SettingSwap& one : swap.swaps)
    names.push_back({{"of", one.side == RunPair::Side::a ? "a" : "b"}, {"setting", name_of(one)}});
  return {{"swaps", names},
          {"a", swap.a.name.text},
          {"a_dt", swap.a.dt.text},
          {"b", swap.b.name.text},
          {"b_dt", swap.b.dt.text},
          {"closes", swap.closes},
          {"closes_at_half_step", swap.is_checked ? Json(swap.closes_at_half_step) : Json(nullptr)}};
}

Json json_of_truth(const DivergenceTruth& truth) {
  if (!truth.why.empty()) return {{"none", truth.why}};
  const std::optional<RunPair::Side> nearer = truth.nearer();
  return {{"a", truth.a},
          {"b", truth.b},
          {"nearer", nearer ? Json(*nearer == RunPair::Side::a ? "a" : "b") : Json(nullptr)},
          {"error", truth.error},
          {"a_is_made_by_it", truth.is_made_like_a},
          {"b_is_made_by_it", truth.is_made_like_b}};
}

}  // namespace

Json divergence_json(const Divergence& found, const std::string& command, const std::vector<std::string>& calls) {
  const PartingBounds& bounds = found.bounds;
  Json json = {{"case", found.case_id},
               {"a", json_of_run(found.a, found.in_a, found.spread_a)},
               {"b", json_of_run(found.b, found.in_b, found.spread_b)},
               {"bounds",
                {{"position", json_of_bound(bounds.position)},
                 {"orientation", json_of_bound(bounds.orientation)},
                 {"velocity", json_of_bound(bounds.velocity)},
                 {"angular_velocity", json_of_bound(bounds.angular_velocity)}}},
               {"compared", found.compared},
               {"ended", found.ended},
               {"largest_share", found.largest.share},
               {"gap", {{"time", found.gap.time}, {"share", found.gap.share}}},
               {"parting", found.parting ? json_of_parting(found) : Json(nullptr)}};
  if (!found.parting) return json;
  json["truth"] = json_of_truth(found.truth);
  json["injections"] = json_of_injections(found);
  Json causes = Json::array(), swaps = Json::array();
  for (const Cause& cause : found.causes) causes.push_back(json_of_cause(cause, found));
  for (const TriedSwap& swap : found.swaps.tried) swaps.push_back(json_of_swap(swap));
  json["causes"] = causes, json["swaps"] = swaps;
  json["setting"] = found.swaps.best ? json_of_swap(*found.swaps.best) : Json(nullptr);
  json["differing_settings"] = found.swaps.has_differing_setting;
  json["command"] = command, json["calls"] = calls;
  return json;
}

}  // namespace rigor::inline report
