#include "cases/report/wording/findings/impacts_finding.h"

#include <fmt/format.h>

#include <map>

#include "cases/report/wording/contact_explanation.h"

namespace rigor {
namespace {

// What is said of runs for one cause.
struct Seen {
  std::vector<std::string> names;
  Diagnosis worst;
};

// By cause; of these runs, in this order.
std::map<std::string, Seen> seen(const std::vector<Diagnosis>& all, const char* topic, const Results& results,
                                 const std::vector<std::size_t>& runs) {
  constexpr double kMostBelieved = 1;  // more than all of the speed is no matter of restitution
  std::map<std::string, Seen> by_cause;
  for (const std::size_t run : runs) {
    for (const Diagnosis& found : all) {
      if (found.topic != topic || found.runs.front() != run || found.value > kMostBelieved) continue;
      Seen& one = by_cause[found.cause];
      const std::string& name = results.runs[run].text;
      if (one.names.empty() || one.names.back() != name) one.names.push_back(name);
      if (found.value > one.worst.value) one.worst = found;
    }
  }
  return by_cause;
}

}  // namespace

std::optional<Finding> impacts_finding(const Results& results, const std::vector<std::size_t>& runs) {
  std::vector<Diagnosis> all;
  for (const CaseResult& result : results.cases) {
    for (Diagnosis& found : contact_diagnoses(result)) all.push_back(std::move(found));
  }
  Finding finding{"impacts", "", ""};
  const auto add = [&](const std::string& what, const char* topic, const auto& worst_of) {
    std::string said;
    for (const auto& [cause, one] : seen(all, topic, results, runs)) {
      said += fmt::format("{}{} ({}: {})", said.empty() ? "" : "; ", fmt::join(one.names, ", "), one.worst.of_case,
                          worst_of(one.worst));
      if (!cause.empty())
        finding.more += fmt::format("{}{}: {}", finding.more.empty() ? "" : " ", fmt::join(one.names, ", "), cause);
    }
    if (!said.empty()) finding.text += (finding.text.empty() ? "" : " ") + what + ": " + said + ".";
  };
  add("Bounces that do not converge as dt falls", kUnconverged,
      [](const Diagnosis& worst) { return "restitution off by " + text_over_steps(worst) + " s"; });
  add("Overlaps pushed out as speed, so that bodies pop apart", kOverlapGivenBack,
      [](const Diagnosis& worst) { return fmt::format("{:.2g} of the speed they met with", worst.value); });
  if (finding.text.empty()) return std::nullopt;
  return finding;
}

}  // namespace rigor
