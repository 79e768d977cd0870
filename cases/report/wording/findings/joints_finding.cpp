#include "cases/report/wording/findings/joints_finding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cases/analysis/joint_diagnosis.h"
#include "cases/report/wording/wording.h"

namespace rigor::inline report {
namespace {

// The worst gap of a run over the cases that it ran and did not blow up in.
struct WorstGap {
  std::size_t cases = 0;
  double over_size = 0, gap = 0, size = 0;  // m, but for the ratio
  std::string of_case;
};

WorstGap worst_gap(const Results& results, std::size_t run, const StepSize& dt) {
  WorstGap worst;
  for (const CaseResult& result : results.cases) {
    for (const Cell& cell : result.cells) {
      const auto found = cell.metrics.find("joint_gap");
      if (cell.run != run || !(cell.dt == dt) || found == cell.metrics.end() || !found->second.not_applicable.empty() ||
          cell.stability.verdict == Verdict::blown_up)
        continue;
      ++worst.cases;
      const double size = joint_size(result.definition.scene), ratio = found->second.value / size;
      if (ratio > worst.over_size) worst = {worst.cases, ratio, found->second.value, size, result.definition.id};
    }
  }
  return worst;
}

}  // namespace

std::optional<Finding> joints_finding(const Results& results, const std::vector<std::size_t>& runs,
                                      const StepSize& dt) {
  constexpr double kHolds = 1e-6;  // of the joint's size: a micrometre of a metre
  constexpr std::size_t kMost = 6;
  std::vector<std::string> hold, stretch, ours;
  Claims claims;
  for (const std::size_t run : runs) {
    const WorstGap worst = worst_gap(results, run, dt);
    if (worst.cases == 0) continue;
    const std::string& name = results.runs[run].text;
    Claim ratio{"worst joint gap over size", "", name, dt.text, "", worst.over_size};
    ratio.relation = worst.over_size <= kHolds ? Relation::at_most : Relation::above, ratio.bound = kHolds;
    claims.state(ratio);
    if (worst.over_size <= kHolds) {
      (is_in_house(results, run) ? ours : hold).push_back(name);
      continue;
    }
    stretch.push_back(
        fmt::format("{} {} of {} ({})", name,
                    claims.quantity({"worst joint gap", worst.of_case, name, dt.text, "", worst.gap}, "m"),
                    claims.quantity({"joint size", worst.of_case, "", "", "", worst.size}, "m"), worst.of_case));
  }
  if (hold.empty() && stretch.empty() && ours.empty()) return std::nullopt;
  std::vector<std::string> all = hold, named = hold;
  all.insert(all.end(), ours.begin(), ours.end());
  if (ours.size() > kMost) {
    named.push_back(fmt::format("{} core methods", claims.count({"core methods whose joints hold", "", "", dt.text, "",
                                                                 static_cast<double>(ours.size())})));
  } else {
    named.insert(named.end(), ours.begin(), ours.end());
  }
  if (stretch.size() > kMost)
    claims.count({"runs beyond the named: joints", "", "", dt.text, "", static_cast<double>(stretch.size() - kMost)});
  const auto listed = [](const std::vector<std::string>& list, const char* separator) {
    return list.empty() ? "none" : fmt::format("{}", fmt::join(list, separator));
  };
  return Finding{"joints",
                 fmt::format("Joints at dt = {} s, without blow-ups. They hold to a millionth of their size: {}. They "
                             "come apart: {}.",
                             dt.text, listed(named, ", "), stretch.empty() ? "none" : listed_names(stretch, kMost)),
                 fmt::format("Hold: {}. Come apart: {}.", listed(all, ", "), listed(stretch, "; ")), claims.take()};
}

}  // namespace rigor::inline report
