#include "cases/analysis/tuning/tuning_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "cases/runner/grid.h"

namespace rigor::inline analysis {

std::vector<ProbeAnswer> Prober::run(const std::vector<Probe>& probes, const ProbeEffort& effort) {
  if (probes.empty()) return {};
  Results grid = planned(probes, effort.share);
  GridOptions options;
  options.jobs = effort.jobs, options.limit = std::min(effort.limit, options_.limit);
  options.stable_steps = options.is_thorough = options.spreads = false;
  for (const Bound& bound : bounds_) options.only_metrics.push_back(bound.metric);
  if (effort.is_timed) options.only_metrics.push_back("cost");
  run_grid(grid, engines_, options, [&](std::size_t done, std::size_t) {
    if (options_.on_runs) options_.on_runs(runs_ + done);
  });
  runs_ += probes.size() * cases_.size();
  std::vector<ProbeAnswer> answers(probes.size());
  for (std::size_t i = 0; i < probes.size(); ++i) {
    answers[i].error = 0;
    for (const CaseResult& result : grid.cases) add(answers[i], result, result.cells[i]);
  }
  if (effort.share < 1) remarks_.clear();  // those of whole runs count
  return answers;
}

Results Prober::planned(const std::vector<Probe>& probes, double share) const {
  Results grid;
  grid.engines = infos_of(engines_);
  std::map<std::string, std::size_t> runs;
  for (const Probe& probe : probes) {
    if (runs.emplace(probe.run, grid.runs.size()).second)
      grid.runs.push_back(parse_run_name(probe.run, engines_.infos()));
  }
  for (const Case& definition : cases_) {
    CaseResult result;
    result.definition = definition;
    result.definition.gates.clear();
    result.definition.duration *= share;
    for (const Probe& probe : probes) result.cells.push_back(cell_of(probe, runs.at(probe.run), grid, result));
    result.stable_steps.resize(grid.runs.size());
    for (StableStepResult& stable : result.stable_steps) skip(stable, SkipReason::not_asked_for);
    grid.cases.push_back(std::move(result));
  }
  return grid;
}

Cell Prober::cell_of(const Probe& probe, std::size_t run, const Results& grid, const CaseResult& result) const {
  const RunName& name = grid.runs[run];
  Cell cell;
  cell.run = run, cell.dt = tuned_steps()[probe.step];
  std::string why =
      why_unsupported(engines_.info_of(name.engine), name.settings, result.definition.scene, cell.dt.seconds);
  if (cell.dt.seconds > result.definition.duration) why = "the step is longer than the run";
  if (!why.empty()) cell.status = Status::unsupported, cell.reason = why;
  return cell;
}

void Prober::add(ProbeAnswer& answer, const CaseResult& result, const Cell& cell) {
  const auto fail = [&](const std::string& why) {
    answer.error = ProbeAnswer::kNone;
    if (answer.why.empty()) answer.why = fmt::format("{}: {}", result.definition.id, why);
  };
  answer.seconds = std::max(answer.seconds, cell.wall_seconds);
  if (cell.status != Status::pass) {
    answer.is_late |= cell.status == Status::timed_out;
    answer.values.push_back(ProbeAnswer::kNone);
    return fail(cell.reason);
  }
  for (const Bound& bound : bounds_) {
    const MetricValue& found = cell.metrics.at(bound.metric);
    answer.values.push_back(found.value);
    if (!found.not_applicable.empty()) return fail(fmt::format("{}: {}", bound.metric, found.not_applicable));
    if (found.is_held_to_itself) {
      return fail(fmt::format("{}: the truth '{}' is made by the same code as this run, and cannot judge it",
                              bound.metric, result.definition.truth));
    }
    // A run judged to less than its end, and a step, is one whose truth ends there.
    if (found.compared_until < result.definition.duration - cell.dt.seconds) {
      remarks_.insert(fmt::format("{}: {} is compared up to {:.3g} s of {:g} s, as far as the truth is sure of itself",
                                  result.definition.id, bound.metric, found.compared_until,
                                  result.definition.duration));
    }
    answer.error = std::max(answer.error, std::abs(found.value) / bound.most);
  }
  const auto cost = cell.metrics.find("cost");
  if (cost != cell.metrics.end()) answer.cost += cost->second.value;
}

}  // namespace rigor::inline analysis
