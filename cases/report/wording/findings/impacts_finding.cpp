#include "cases/report/wording/findings/impacts_finding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "cases/report/wording/explanations/contact_explanation.h"

namespace rigor {
namespace {

// Runs with the same cause, and the worst of their diagnoses.
struct SameCause {
  std::vector<std::string> names;
  Diagnosis worst;
};

// By cause; of these runs, in this order.
std::map<std::string, SameCause> by_cause(const std::vector<Diagnosis>& all, const char* topic, const Results& results,
                                          const std::vector<std::size_t>& runs) {
  constexpr double kMostBelieved = 1;  // more than the whole speed is not a matter of restitution
  std::map<std::string, SameCause> found;
  for (const std::size_t run : runs) {
    for (const Diagnosis& one : all) {
      if (one.topic != topic || one.runs.front() != run || one.value > kMostBelieved) continue;
      SameCause& same = found[one.cause];
      const std::string& name = results.runs[run].text;
      if (same.names.empty() || same.names.back() != name) same.names.push_back(name);
      if (one.value > same.worst.value) same.worst = one;
    }
  }
  return found;
}

}  // namespace

std::optional<Finding> impacts_finding(const Results& results, const std::vector<std::size_t>& runs) {
  std::vector<Diagnosis> all;
  for (const CaseResult& result : results.cases) {
    for (Diagnosis& found : contact_diagnoses(result)) all.push_back(std::move(found));
  }
  Finding finding{"impacts", "", ""};
  Claims claims;
  const auto add = [&](const std::string& what, const char* topic, const auto& text_of) {
    std::string said;
    for (const auto& [cause, same] : by_cause(all, topic, results, runs)) {
      said += fmt::format("{}{} (worst: {} on {}, {})", said.empty() ? "" : "; ", fmt::join(same.names, ", "),
                          results.runs[same.worst.runs.front()].text, same.worst.of_case, text_of(same.worst));
      if (!cause.empty())
        finding.more += fmt::format("{}{}: {}", finding.more.empty() ? "" : " ", fmt::join(same.names, ", "), cause);
    }
    if (!said.empty()) finding.text += (finding.text.empty() ? "" : " ") + what + ": " + said + ".";
  };
  add("Restitution errors that do not fall with dt", kUnconverged,
      [&](const Diagnosis& worst) { return text_over_steps(results, worst, "restitution_error", "", claims); });
  add("Overlaps pushed out as speed", kOverlapGivenBack, [&](const Diagnosis& worst) {
    return claims.percent(
               claim_of(results, worst, worst.over.front().first, "worst found of restitution_error", worst.value)) +
           " of the approach speed";
  });
  if (finding.text.empty()) return std::nullopt;
  finding.claims = claims.take();
  return finding;
}

}  // namespace rigor
