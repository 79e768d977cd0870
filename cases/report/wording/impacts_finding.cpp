#include "cases/report/wording/impacts_finding.h"

#include <fmt/format.h>

#include <map>

#include "cases/report/wording/contact_explanation.h"

namespace rigor {
namespace {

// What is said of these runs for one reason.
struct Seen {
  std::vector<std::string> names;
  ContactFault worst;
  std::string where;
};

template <typename F>
std::map<std::string, Seen> seen(const Results& results, const std::vector<std::size_t>& runs, const F& fault_of) {
  constexpr double kMostBelieved = 1;  // more than all of the speed is no matter of restitution
  std::map<std::string, Seen> by_reason;
  for (const std::size_t run : runs) {
    for (const CaseResult& result : results.cases) {
      const std::optional<ContactFault> fault = fault_of(result, run);
      if (!fault || fault->size > kMostBelieved) continue;
      Seen& one = by_reason[fault->reason];
      const std::string& name = results.runs[run].text;
      if (one.names.empty() || one.names.back() != name) one.names.push_back(name);
      if (fault->size > one.worst.size) one.worst = *fault, one.where = result.definition.id;
    }
  }
  return by_reason;
}

}  // namespace

std::optional<Finding> impacts_finding(const Results& results, const std::vector<std::size_t>& runs) {
  Finding finding{"impacts", "", ""};
  const auto add = [&](const std::string& what, const std::map<std::string, Seen>& by_reason, const auto& worst_of) {
    std::string said;
    for (const auto& [reason, one] : by_reason) {
      said += fmt::format("{}{} ({}: {})", said.empty() ? "" : "; ", fmt::join(one.names, ", "), one.where,
                          worst_of(one.worst));
      if (!reason.empty())
        finding.more += fmt::format("{}{}: {}", finding.more.empty() ? "" : " ", fmt::join(one.names, ", "), reason);
    }
    if (!said.empty()) finding.text += (finding.text.empty() ? "" : " ") + what + ": " + said + ".";
  };
  add("Bounces that do not converge as dt falls", seen(results, runs, unconverged_restitution),
      [](const ContactFault& worst) { return "restitution off by " + worst.series; });
  add("Overlaps pushed out as speed, so that bodies pop apart", seen(results, runs, overlap_given_back),
      [](const ContactFault& worst) { return fmt::format("{:.2g} of the speed they met with", worst.size); });
  if (finding.text.empty()) return std::nullopt;
  return finding;
}

}  // namespace rigor
