#include "cases/report/json/pairs/repeats_json.h"

#include <cmath>

#include "core/base/json.h"

namespace rigor::inline report {
namespace {

// JSON has no infinity.
Json json_of_number(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

Json json_of_outcome(const RepeatOutcome& outcome) {
  Json json = {{"change", outcome.change},
               {"label", outcome.label},
               {"must_hold", outcome.must_hold},
               {"status", outcome.has_failed   ? "failed"
                          : !outcome.is_run    ? "not-applicable"
                          : outcome.difference ? "differs"
                                               : "same-bits"},
               {"why", outcome.why}};
  if (!outcome.difference) return json;
  const BitDifference& difference = *outcome.difference;
  json["step"] = difference.step;
  if (difference.column < 0) return json;
  json["body"] = outcome.body, json["component"] = kColumnNames[static_cast<std::size_t>(difference.column)];
  json["difference"] = json_of_number(difference.there), json["position"] = json_of_number(difference.position);
  json["orientation"] = json_of_number(difference.angle), json["like_rounding"] = outcome.is_like_rounding;
  return json;
}

}  // namespace

Json repeats_json(const RepeatReport& report) {
  Json outcomes = Json::array();
  for (const RepeatOutcome& outcome : report.outcomes) outcomes.push_back(json_of_outcome(outcome));
  return {{"case", report.case_id}, {"run", report.run.text},      {"dt", report.dt.text},
          {"steps", report.steps},  {"repeats", report.repeats()}, {"changes", outcomes}};
}

}  // namespace rigor::inline report
