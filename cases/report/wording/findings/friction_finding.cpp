#include "cases/report/wording/findings/friction_finding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cases/analysis/energy_diagnosis.h"
#include "cases/report/wording/findings/headline_cells.h"
#include "cases/report/wording/wording.h"

namespace rigor::inline report {

// Two friction forces along fixed axes, each limited by itself, brake along the diagonal with sqrt(2) of the force.
// Stopping distances then spread by 1 - 1/sqrt(2) = 0.29 over the directions. A cone has no spread.
std::optional<Finding> friction_finding(const Results& results, const RunNames& names, const StepSize& dt) {
  constexpr double kPyramid = 0.2, kCone = 0.05;
  constexpr std::size_t kMost = 6;
  std::vector<std::size_t> cones;
  std::vector<std::string> pyramids, others, cases;
  Claims claims;
  for (const std::size_t run : names.order()) {
    double worst = -1;
    for_headline_cells(results, run, dt, [&](const CaseResult& result, const Cell& cell) {
      const double spread = std::abs(signed_value(cell.metrics, "friction_anisotropy"));
      if (cell.stability.verdict == Verdict::blown_up || std::isnan(spread)) return;
      worst = std::max(worst, spread);
      const std::string& id = result.definition.id;
      if (std::find(cases.begin(), cases.end(), id) == cases.end()) cases.push_back(id);
    });
    if (worst < 0) continue;
    Claim claim{"worst friction_anisotropy", "", names.of(run), dt.text, "", worst};
    if (worst < kCone) {
      claim.relation = Relation::below, claim.bound = kCone;
      cones.push_back(run), claims.state(claim);
      continue;
    }
    claim.relation = worst >= kPyramid ? Relation::at_least : Relation::below, claim.bound = kPyramid;
    auto& list = worst >= kPyramid ? pyramids : others;
    if (list.size() < kMost) {
      list.push_back(fmt::format("{} ({})", names.of(run), claims.percent(claim)));
    } else {
      list.push_back(names.of(run)), claims.state(claim);
    }
  }
  if (pyramids.empty() && cones.empty() && others.empty()) return std::nullopt;
  const auto listed = [&](const std::vector<std::string>& list) {
    if (list.size() <= kMost) return listed_names(list, kMost);
    claims.count({"runs beyond the named: friction", "", "", dt.text, "", static_cast<double>(list.size() - kMost)});
    return listed_names(list, kMost);
  };
  std::string text =
      fmt::format("Friction stronger along diagonals (a pyramid): {}. Equal in all directions (a cone): {}.",
                  pyramids.empty() ? "none" : listed(pyramids),
                  names.brief(cones, names.ours_among(cones), "cone friction", claims));
  if (!others.empty()) text += fmt::format(" Uneven, but no pyramid: {}.", listed(others));
  return Finding{
      "friction", text,
      fmt::format("The percentage is the spread of stopping distances over directions ({}, dt = {} s). Cones: "
                  "{}.",
                  fmt::join(cases, ", "), dt.text, names.all(cones)),
      claims.take()};
}

}  // namespace rigor::inline report
