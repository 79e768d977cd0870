#include "cases/laboratory/sentences.h"

#include <fmt/format.h>

#include <utility>

#include "cases/analysis/small_motions/oscillator_growth.h"
#include "cases/analysis/small_motions/small_motions.h"
#include "cases/report/wording/explanations/explanation.h"
#include "cases/report/wording/wording.h"
#include "core/engine/run_name.h"

namespace rigor::inline laboratory {

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
    const auto growth = energy_growth(run, motions->stiffest_element().kind, motions->stiffest(), dt.seconds);
    if (growth) mode.growth[run] = *growth;
  }
  return mode;
}

std::string sentence_on(const LiveMode& mode, const StepSize& dt) {
  std::string text =
      fmt::format("The stiffest spring mode has ω = {}, so ω dt = {} at dt = {} s.",
                  quantity_text(mode.frequency, "rad/s"), two_digits(mode.frequency * dt.seconds), dt.text);
  std::string factors;
  for (const auto& [run, growth] : mode.growth)
    factors += fmt::format("{} {} ({})", factors.empty() ? "" : ",", three_digits(growth), run);
  if (!factors.empty()) text += fmt::format(" One step multiplies its energy by{}.", factors);
  return text;
}

}  // namespace rigor::inline laboratory
