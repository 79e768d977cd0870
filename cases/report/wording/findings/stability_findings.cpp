#include "cases/report/wording/findings/stability_findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cases/analysis/small_motions/stiffest_frequency.h"
#include "cases/report/wording/findings/headline_cells.h"
#include "cases/report/wording/wording.h"

namespace rigor::inline report {
namespace {

// How the cells of one run ended.
struct Endings {
  std::size_t run = 0;
  std::size_t ran = 0, blown = 0, unstable = 0;  // unstable: neither stable nor blown up
  std::vector<std::string> blown_cases;

  void add(const CaseResult& result, const Cell& cell) {
    ++ran;
    if (cell.stability.verdict == Verdict::blown_up)
      ++blown, blown_cases.push_back(result.definition.id);
    else if (cell.stability.verdict != Verdict::stable)
      ++unstable;
  }
};

Claim claim_of_run(const RunNames& names, const Endings& one, const StepSize& dt, const std::string& quantity,
                   std::size_t value) {
  return {quantity, "", names.of(one.run), dt.text, "", static_cast<double>(value)};
}

// "ode in 2 of 9 cases; core:rk4 in 1 of 9; 5 core methods in some". States each run's counts.
std::string losers(const RunNames& names, const std::vector<Endings>& all, const StepSize& dt, const std::string& of,
                   std::size_t all_ours, Claims& claims) {
  GroupedNames named;
  std::vector<std::size_t> ours;
  for (const Endings& one : all) {
    if (names.is_ours(one.run)) ours.push_back(one.run);
  }
  for (const Endings& one : all) {
    if (names.is_ours(one.run) && ours.size() > RunNames::kFewOfOurs) continue;
    const std::string blown = claims.count(claim_of_run(names, one, dt, of + "that blew up", one.blown));
    const std::string ran = claims.count(claim_of_run(names, one, dt, of + "that ran", one.ran));
    named.add(names.of(one.run), fmt::format(" in {} of {} case{}", blown, ran, one.ran == 1 ? "" : "s"));
  }
  if (ours.size() > RunNames::kFewOfOurs)
    named.add(names.brief(ours, all_ours, of + "that blew up", claims), " in some");
  return named.text();
}

std::vector<std::size_t> runs_of_all(const std::vector<Endings>& all) {
  std::vector<std::size_t> runs;
  for (const Endings& one : all) runs.push_back(one.run);
  return runs;
}

}  // namespace

std::optional<Finding> blow_up_finding(const Results& results, const RunNames& names, const StepSize& dt) {
  std::vector<Endings> steady, lost;
  GroupedNames where;
  for (const std::size_t run : names.order()) {
    Endings one;
    one.run = run;
    for_headline_cells(results, run, dt, [&](const CaseResult& result, const Cell& cell) { one.add(result, cell); });
    if (one.blown == 0 && 2 * one.ran > results.cases.size()) steady.push_back(one);
    if (one.blown == 0) continue;
    lost.push_back(one);
    where.add(names.of(run), fmt::format(" in {}", fmt::join(one.blown_cases, ", ")));
  }
  if (lost.empty() && steady.empty()) return std::nullopt;
  Claims claims;
  for (const Endings& one : steady) claims.state(claim_of_run(names, one, dt, "cells that blew up", 0));
  if (lost.empty())
    return Finding{"stability", fmt::format("At dt = {} s nothing blows up.", dt.text), "", claims.take()};
  const std::size_t all_ours = names.ours_among(runs_of_all(steady)) + names.ours_among(runs_of_all(lost));
  const std::string text = fmt::format("Blow-ups at dt = {} s: {}. No blow-up: {}.", dt.text,
                                       losers(names, lost, dt, "cells ", all_ours, claims),
                                       names.brief(runs_of_all(steady), all_ours, "cells that never blew up", claims));
  return Finding{"stability", text,
                 fmt::format("Blown up: {}. Never: {}.", where.text(), names.all(runs_of_all(steady))), claims.take()};
}

// Springs are stiff for a step once ω dt comes near 2, where a semi-implicit step loses every oscillation.
std::optional<Finding> stiff_springs_finding(const Results& results, const RunNames& names, const StepSize& dt) {
  constexpr double kStiff = 1;  // ω dt
  std::vector<std::string> ids;
  for (const CaseResult& result : results.cases) {
    if (stiffest_frequency(result.definition.scene) * dt.seconds >= kStiff) ids.push_back(result.definition.id);
  }
  const auto is_stiff = [&](const CaseResult& result) {
    return std::find(ids.begin(), ids.end(), result.definition.id) != ids.end();
  };
  std::vector<Endings> stable, unstable, lost;
  Claims claims;
  for (const std::size_t run : names.order()) {
    Endings one;
    one.run = run;
    for_headline_cells(results, run, dt, [&](const CaseResult& result, const Cell& cell) {
      if (is_stiff(result)) one.add(result, cell);
    });
    if (one.ran == 0 || 2 * one.ran < ids.size()) continue;
    (one.blown > 0 ? lost : one.unstable > 0 ? unstable : stable).push_back(one);
    if (one.blown == 0) claims.state(claim_of_run(names, one, dt, "stiff cells that blew up", 0));
    if (one.blown == 0 && one.unstable == 0)
      claims.state(claim_of_run(names, one, dt, "stiff cells that are not stable", 0));
  }
  if (stable.empty() && unstable.empty() && lost.empty()) return std::nullopt;
  std::size_t all_ours = 0;
  for (const auto* list : {&stable, &unstable, &lost}) all_ours += names.ours_among(runs_of_all(*list));
  std::string text = fmt::format("Springs with ω dt of 1 or more at dt = {} s. Stable: {}.", dt.text,
                                 names.brief(runs_of_all(stable), all_ours, "stiff cells that are all stable", claims));
  std::string more = fmt::format("Stable: {}.", names.all(runs_of_all(stable)));
  if (!unstable.empty()) {
    text += fmt::format(" Bounded, but not stable: {}.",
                        names.brief(runs_of_all(unstable), all_ours, "stiff cells that are bounded", claims));
    more += fmt::format(" Bounded, but not stable: {}.", names.all(runs_of_all(unstable)));
  }
  if (!lost.empty()) {
    text += fmt::format(" Blown up: {}.", losers(names, lost, dt, "stiff cells ", all_ours, claims));
    more += fmt::format(" Blown up: {}.", names.all(runs_of_all(lost)));
  }
  return Finding{"stiff springs", text, more + fmt::format(" The cases: {}.", fmt::join(ids, ", ")), claims.take()};
}

}  // namespace rigor::inline report
