#include "cases/laboratory/sentences.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cases/analysis/small_motions/oscillator_growth.h"
#include "cases/analysis/small_motions/small_motions.h"
#include "cases/report/wording/explanations/explanation.h"
#include "cases/report/wording/wording.h"
#include "core/engine/run_name.h"

namespace rigor {
namespace {

// The element that stands for the mode, as in the report.
ForceElement::Kind kind_of_stiffest(const SmallMotions& motions) {
  const auto& elements = motions.elements();
  return std::max_element(
             elements.begin(), elements.end(),
             [](const auto& a, const auto& b) { return a.stiffness / a.inertia < b.stiffness / b.inertia; })
      ->kind;
}

}  // namespace

std::vector<Message> live_explanations(const EngineTable& engines, const Case& changed, const StepSize& dt,
                                       const std::vector<LiveRun>& runs) {
  Results results;
  results.engines = engines.infos();
  CaseResult result;
  result.definition = changed;
  result.definition.dt = {dt};
  StableStepResult not_searched;
  skip(not_searched, SkipReason::not_asked_for);
  for (const LiveRun& live : runs) {
    results.runs.push_back(parse_run_name(live.run, results.engines));
    result.stable_steps.push_back(not_searched);
    Cell& cell = result.cells.emplace_back(live.cell);
    cell.run = results.runs.size() - 1, cell.dt = dt;
  }
  return explanations(results, result);
}

std::optional<LiveMode> stiffest_mode(const Case& changed, const StepSize& dt, const std::vector<std::string>& runs) {
  const auto motions = SmallMotions::of(changed.scene);
  if (!motions || !(motions->stiffest().frequency > 0)) return {};
  LiveMode mode{motions->stiffest().frequency, largest_semi_implicit_step(motions->stiffest()), {}};
  for (const std::string& run : runs) {
    const auto growth = energy_growth(run, kind_of_stiffest(*motions), motions->stiffest(), dt.seconds);
    if (growth) mode.growth[run] = *growth;
  }
  return mode;
}

std::string sentence_on(const LiveMode& mode, const StepSize& dt) {
  std::string text =
      fmt::format("The stiffest spring mode has ω = {}, so ω dt = {} at dt = {} s.",
                  quantity_text(mode.frequency, "rad/s"), two_digits(mode.frequency * dt.seconds), dt.text);
  GroupedNames said;
  for (const auto& [run, growth] : mode.growth) said.add(run, " by " + three_digits(growth));
  if (!said.empty()) text += fmt::format(" One step multiplies its energy: {}.", said.text());
  return text;
}

}  // namespace rigor
