#include "cases/runner/trials/trials.h"

#include <fmt/format.h>

#include "cases/results/trial_results.h"
#include "cases/truth/recorded/recorded_motion.h"

namespace rigor::inline runner {
namespace {

struct Trials {
  std::vector<Cell> cells;
  std::vector<TrialResult> results;
  Recordings recordings;  // of all trials
};

Recorders recorders_of_trial(const Recorders& all, std::size_t trial) {
  Recorders chosen = all;
  if (trial > 0) std::erase_if(chosen, [](const auto& recorder) { return !recorder->keeps_each_trial(); });
  return chosen;
}

// From the best to the worst.
int rank_of(Status status) {
  switch (status) {
    case Status::pass:
      return 0;
    case Status::unsupported:
      return 1;
    case Status::diverged:
      return 2;
    case Status::invalid:
      return 3;
    default:
      return 4;
  }
}

// The mean of a metric, with the worst trial's instant; where no trial has a value, the first trial's reason.
MetricValue mean_of(const std::string& metric, const Trials& trials) {
  const auto spread = spread_over(trials.results, metric);
  MetricValue mean;
  double first_seconds = 0;
  for (std::size_t i = 0; i < trials.cells.size(); ++i) {
    const auto found = trials.cells[i].metrics.find(metric);
    if (found == trials.cells[i].metrics.end()) continue;
    const MetricValue& one = found->second;
    if (!spread && mean.not_applicable.empty()) mean.not_applicable = one.not_applicable;
    if (!one.not_applicable.empty()) continue;
    if (trials.results[i].name == spread->worst) mean.worst = one.worst, mean.compared_until = one.compared_until;
    mean.is_held_to_itself |= one.is_held_to_itself;
    first_seconds += one.first_second;
  }
  if (spread) mean.value = spread->mean, mean.first_second = first_seconds / static_cast<double>(spread->count);
  return mean;
}

std::size_t worst_of(const std::vector<Cell>& cells) {
  std::size_t worst = 0;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const Cell &one = cells[i], &other = cells[worst];
    const bool is_worse = rank_of(one.status) != rank_of(other.status)
                              ? rank_of(one.status) > rank_of(other.status)
                              : one.stability.verdict > other.stability.verdict;
    if (is_worse) worst = i;
  }
  return worst;
}

Cell summary_of(const Trials& trials) {
  const std::size_t worst = worst_of(trials.cells);
  Cell cell = trials.cells.front();
  cell.status = trials.cells[worst].status, cell.stability = trials.cells[worst].stability;
  const std::string name = fmt::format("trial '{}': ", trials.results[worst].name);
  cell.stability.why = name + cell.stability.why;
  std::size_t failed = 0;
  cell.cpu_seconds = cell.wall_seconds = 0;
  for (const Cell& one : trials.cells) {
    failed += one.status != Status::pass;
    cell.cpu_seconds += one.cpu_seconds, cell.wall_seconds += one.wall_seconds;
    if (!cell.reduced_order) cell.reduced_order = one.reduced_order;
    if (!cell.sub_step) cell.sub_step = one.sub_step;
    for (const auto& [metric, value] : one.metrics) cell.metrics.try_emplace(metric);
  }
  cell.reason =
      failed == 0 ? ""
                  : fmt::format("{} of {} trials; {}{}", failed, trials.cells.size(), name, trials.cells[worst].reason);
  for (auto& [metric, value] : cell.metrics) value = mean_of(metric, trials);
  cell.recordings = trials.recordings;
  keep_trials(cell, trials.results);
  return cell;
}

}  // namespace

JudgedCell run_trials(const Case& definition, const std::shared_ptr<const MotionRecording>& recording,
                      const GridOptions& options, const RunTrial& run) {
  Trials trials;
  Path path;
  for (std::size_t k = 0; k < recording->trials.size(); ++k) {
    const Case one = case_of_trial(definition, *recording, k);
    const RecordedMotion truth(recording, k, one.scene);
    GridOptions of_trial = options;
    of_trial.recorders = recorders_of_trial(options.recorders, k);
    Cell cell;
    try {
      JudgedCell judged = run(one, truth, facts_of(one, &truth), of_trial);
      cell = std::move(judged.cell);
      if (k == 0) path = std::move(judged.path);
    } catch (const EngineFailure& failure) {
      if (k == 0 && failure.kind() == FailureKind::unsupported) throw;
      cell.status = status_of(failure.kind()), cell.reason = failure.what();
    }
    TrialResult result{recording->trials[k].name, cell.status, cell.reason, {}};
    for (const auto& [metric, value] : cell.metrics)
      if (value.not_applicable.empty()) result.metrics[metric] = value.value;
    for (auto& [name, kept] : cell.recordings) trials.recordings[recording_of_trial(name, k)] = std::move(kept);
    trials.cells.push_back(std::move(cell)), trials.results.push_back(std::move(result));
  }
  return {summary_of(trials), path};
}

Recordings recordings_of_truth(const Case& definition, const Truth& truth, const TruthFacts& facts,
                               const Recorders& recorders) {
  Recordings found;
  const auto keep = [&](const Case& one, const Truth& of_one, const TruthFacts& facts_of_one, std::size_t trial) {
    for (const auto& recorder : recorders_of_trial(recorders, trial)) {
      Recording kept = recorder->of_truth(one, of_one, facts_of_one);
      if (!kept.empty()) found[recording_of_trial(recorder->name(), trial)] = std::move(kept);
    }
  };
  if (!definition.recording) {
    keep(definition, truth, facts, 0);
    return found;
  }
  for (std::size_t k = 0; k < definition.recording->trials.size(); ++k) {
    const Case one = case_of_trial(definition, *definition.recording, k);
    const RecordedMotion motion(definition.recording, k, one.scene);
    keep(one, motion, facts_of(one, &motion), k);
  }
  return found;
}

}  // namespace rigor::inline runner
