#include "cases/report/json/mistakes_json.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

const char* word_of_verdict(MistakeReport::Verdict verdict) {
  using enum MistakeReport::Verdict;
  switch (verdict) {
    case right:
      return "right";
    case named:
      return "named";
    case alike:
      return "alike";
    case unnamed:
      return "none";
    case untried:
      return "untried";
  }
  return "";
}

Json json_of_suspect(const MistakeReport::Named& suspect) {
  Json cases = Json::array();
  for (const CaseShare& share : suspect.cases)
    cases.push_back({{"case", share.id}, {"error", share.error}, {"left", share.rest}});
  return {{"mistakes", suspect.names},
          {"explains", suspect.explains},
          {"cases_explained", suspect.explained},
          {"cases", cases}};
}

Json json_of_law(const LawDrift& law) {
  return {{"law", law.law},
          {"cases", law.cases},
          {"kept", law.is_kept},
          {"case", law.id},
          {"drift", law.drift},
          {"dt", law.dt},
          {"drift_at_half_dt", law.at_half_dt}};
}

}  // namespace

Json mistakes_json(const MistakeReport& report, const std::string& run) {
  Json suspects = Json::array();
  for (const auto& suspect : report.suspects) suspects.push_back(json_of_suspect(suspect));
  Json laws = Json::array();
  for (const LawDrift& law : report.laws) laws.push_back(json_of_law(law));
  return {{"engine", run},
          {"verdict", word_of_verdict(report.verdict)},
          {"known_mistakes", report.known},
          {"leaders", report.leaders},
          {"suspects", suspects},
          {"cases", report.seen},
          {"cases_off", report.off},
          {"cases_by_twin", report.by_twin.size()},
          {"laws", laws},
          {"not_seen", report.failures},
          {"held_against", report.beside}};
}

}  // namespace rigor::inline report
