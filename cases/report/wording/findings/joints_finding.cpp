#include "cases/report/wording/findings/joints_finding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/analysis/joint_diagnosis.h"
#include "cases/report/wording/verdict_matrix.h"
#include "cases/report/wording/wording.h"

namespace rigor {
namespace {

// What a run's joints do over the cases that it ran and did not blow up in.
struct Held {
  std::size_t cases = 0;
  double worst = 0;   // of the joint's size
  double gap = 0;     // m, then
  std::string where;  // the case
};

Held held_by(const Results& results, std::size_t run, const StepSize& dt) {
  Held held;
  for (const CaseResult& result : results.cases) {
    for (const Cell& cell : result.cells) {
      const auto found = cell.metrics.find("joint_gap");
      if (cell.run != run || !(cell.dt == dt) || found == cell.metrics.end() || !found->second.not_applicable.empty())
        continue;
      const bool blew_up = cell.stability.verdict == Verdict::blown_up;
      held.cases += !blew_up;
      const double share = found->second.value / joint_size(result.definition.scene);
      if (blew_up || !(share > held.worst)) continue;
      held.worst = share, held.gap = found->second.value, held.where = result.definition.id;
    }
  }
  return held;
}

}  // namespace

std::optional<Finding> joints_finding(const Results& results, const std::vector<std::size_t>& runs,
                                      const StepSize& dt) {
  constexpr double kHolds = 1e-6;  // of the joint's size: a micrometre of a metre
  std::vector<std::string> hold, stretch, ours;
  for (const std::size_t run : runs) {
    const Held held = held_by(results, run, dt);
    if (held.cases == 0) continue;
    const std::string& name = results.runs[run].text;
    if (held.worst <= kHolds) {
      (is_in_house(results, run) ? ours : hold).push_back(name);
    } else {
      stretch.push_back(
          fmt::format("{} by {:.2g} m at a size of {:.2g} m ({})", name, held.gap, held.gap / held.worst, held.where));
    }
  }
  if (hold.empty() && stretch.empty() && ours.empty()) return std::nullopt;
  constexpr std::size_t kMost = 6;
  std::vector<std::string> named = hold;
  if (ours.size() > kMost) {
    named.push_back(fmt::format("{} of the core's methods", ours.size()));
  } else {
    named.insert(named.end(), ours.begin(), ours.end());
  }
  std::vector<std::string> all = hold;
  all.insert(all.end(), ours.begin(), ours.end());
  return Finding{
      "joints",
      fmt::format(
          "At dt = {} s, where nothing blows up, joints hold in {}, to a millionth of their size; they stretch in {}.",
          dt.text, named.empty() ? "none" : fmt::format("{}", fmt::join(named, ", ")),
          stretch.empty() ? "none" : listed_names(stretch, kMost)),
      fmt::format("Hold: {}. Stretch: {}.", all.empty() ? "none" : fmt::format("{}", fmt::join(all, ", ")),
                  stretch.empty() ? "none" : fmt::format("{}", fmt::join(stretch, "; ")))};
}

}  // namespace rigor
