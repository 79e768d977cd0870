#include "cases/report/wording/explanations/explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "cases/report/wording/cell_claim.h"
#include "cases/report/wording/explanations/blow_up_explanation.h"
#include "cases/report/wording/explanations/contact_explanation.h"
#include "cases/report/wording/explanations/disagreement_explanation.h"
#include "cases/report/wording/explanations/energy_explanation.h"
#include "cases/report/wording/explanations/ensemble_explanation.h"
#include "cases/report/wording/explanations/joint_explanation.h"

namespace rigor::inline report {
namespace {

// The searches for the largest stable step that left something out; each reason stands with the step in results.json.
std::vector<Message> shortened_searches(const Results& results, const CaseResult& result) {
  std::vector<std::string> names;
  Claims claims;
  for (std::size_t run = 0; run < result.stable_steps.size(); ++run) {
    const StableStepResult& stable = result.stable_steps[run];
    if (stable.status != Status::pass || stable.step.cut.empty()) continue;
    names.push_back(results.runs[run].text);
    claims.state({"shortened search", result.definition.id, names.back(), "", "", 1});
  }
  if (names.empty()) return {};
  return {{"stable step",
           fmt::format("The search for the largest stable step was shortened for: {}.", fmt::join(names, ", ")), "",
           claims.take()}};
}

// The facts behind the verdicts "overlapping", "gaining" and "collapsed".
std::vector<Message> verdict_reasons(const Results& results, const CaseResult& result) {
  std::vector<Message> messages;
  const StepSize dt = coarsest_dt(result);
  for (const Cell& cell : result.cells) {
    if (!(cell.dt == dt) || cell.metrics.empty()) continue;
    const Verdict verdict = cell.stability.verdict;
    if (verdict == Verdict::stable || verdict == Verdict::drifting || verdict == Verdict::blown_up) continue;
    messages.push_back({"verdict",
                        fmt::format("{} is {}: {}.", results.runs[cell.run].text, word_of(verdict), cell.stability.why),
                        "",
                        {claim_of_cell(results, result, cell, "count of " + word_of(verdict), 1)}});
  }
  return messages;
}

}  // namespace

std::vector<Message> explanations(const Results& results, const CaseResult& result) {
  std::vector<Message> all = disagreement_explanations(results, result);
  const auto add = [&](std::vector<Message> more) { std::move(more.begin(), more.end(), std::back_inserter(all)); };
  add(blow_up_explanations(results, result));
  const bool is_damper = std::any_of(all.begin(), all.end(), [](const Message& one) { return one.topic == "damper"; });
  add(energy_explanations(results, result));
  if (!is_damper) add(shortened_searches(results, result));
  add(verdict_reasons(results, result));
  add(contact_explanations(results, result));
  add(joint_explanations(results, result));
  add(ensemble_explanations(results, result));
  return all;
}

}  // namespace rigor::inline report
