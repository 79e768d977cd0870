#include "cases/report/wording/findings/impacts_finding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "cases/report/wording/explanations/contact_explanation.h"

namespace rigor::inline report {
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

std::optional<Diagnosis> worst_of_topic(const std::vector<Diagnosis>& all, const char* topic, std::size_t run) {
  std::optional<Diagnosis> worst;
  for (const Diagnosis& one : all) {
    if (one.topic == topic && one.runs.front() == run && (!worst || one.value > worst->value)) worst = one;
  }
  return worst;
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

std::optional<Finding> contact_forces_finding(const Results& results, const std::vector<std::size_t>& runs) {
  std::vector<Diagnosis> all;
  for (const CaseResult& result : results.cases) {
    for (Diagnosis& found : contact_diagnoses(result)) all.push_back(std::move(found));
  }
  Finding finding{"contact-forces", "", ""};
  Claims claims;
  const auto add = [&](const char* topic, const std::string& what, const auto& text_of) {
    std::string said;
    for (const std::size_t run : runs) {
      const std::optional<Diagnosis> worst = worst_of_topic(all, topic, run);
      if (!worst) continue;
      const std::string& name = results.runs[run].text;
      said += fmt::format("{}{} ({} on {})", said.empty() ? "" : "; ", name, text_of(*worst), worst->of_case);
      if (!worst->cause.empty())
        finding.more += fmt::format("{}{}: {}", finding.more.empty() ? "" : " ", name, worst->cause);
    }
    if (!said.empty()) finding.text += fmt::format("{}{}: {}.", finding.text.empty() ? "" : " ", what, said);
  };
  add(kForceSpikes, "Forces at rest that grow as dt falls, the largest over that of rest",
      [&](const Diagnosis& worst) { return text_over_steps(results, worst, "force_peak", "", claims); });
  add(kCreeps, "Bodies that should stand move on", [&](const Diagnosis& worst) {
    const StepSize& dt = worst.over.back().first;
    return fmt::format("{} at dt = {} s", claims.quantity(claim_of(results, worst, dt, "creep", worst.value), "m"),
                       dt.text);
  });
  add(kHovers, "Bodies press across a gap that falls with dt",
      [&](const Diagnosis& worst) { return text_over_steps(results, worst, "hover", "m", claims); });
  add(kForcesMissing, "Reported contact forces that do not explain the motion", [&](const Diagnosis& worst) {
    const StepSize& dt = worst.over.back().first;
    return fmt::format("{} left at dt = {} s",
                       claims.quantity(claim_of(results, worst, dt, "contact_balance", worst.value), "N"), dt.text);
  });
  if (finding.text.empty()) return std::nullopt;
  finding.claims = claims.take();
  return finding;
}

}  // namespace rigor::inline report
