#include "cases/report/json/fit_json.h"

#include <cmath>

#include "core/base/json.h"

namespace rigor::inline report {
namespace {

// JSON has no infinity and no NaN.
Json json_of_number(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

Json json_of_parameter(const FittedParameter& parameter) {
  Json json = {{"key", parameter.key},         {"unit", parameter.unit}, {"value", parameter.number},
               {"text", parameter.value},      {"interval", nullptr},    {"at_bound", parameter.is_at_bound},
               {"unknown", parameter.unknown}, {"open_ends", nullptr}};
  if (!parameter.interval) return json;
  json["interval"] = {parameter.interval->first, parameter.interval->second};
  json["open_ends"] = {parameter.is_low_open, parameter.is_high_open};
  return json;
}

Json json_of_errors(const FitErrors& errors) {
  constexpr double kRadians = M_PI / 180;
  return {{"trials", errors.trials},
          {"without_result", errors.without_result},
          {"position", json_of_number(errors.position)},
          {"position_spread", json_of_number(errors.position_spread)},
          {"position_unit", errors.is_percent ? "%" : "m"},
          {"rotation", json_of_number(kRadians * errors.rotation)},
          {"rotation_spread", json_of_number(kRadians * errors.rotation_spread)}};
}

}  // namespace

Json fit_json(const FitInput& input, const FitResult& fit) {
  Json cases = Json::array(), parameters = Json::array();
  for (const Case& definition : input.cases)
    cases.push_back({{"case", definition.id}, {"dt", definition.dt.front().text}});
  for (const FittedParameter& parameter : fit.parameters) parameters.push_back(json_of_parameter(parameter));
  return {{"run", input.run.text},
          {"cases", cases},
          {"seed", input.seed},
          {"points", fit.points},
          {"parameters", parameters},
          {"correlations", fit.correlations},
          {"intervals", fit.method},
          {"why_no_intervals", fit.why_no_intervals},
          {"caveats", fit.caveats},
          {"fitted", json_of_errors(fit.training)},
          {"held_out", fit.held_out ? json_of_errors(*fit.held_out) : Json(nullptr)}};
}

}  // namespace rigor::inline report
