#include "cases/cli/progress/plan_sentence.h"

#include <fmt/format.h>

#include <algorithm>

#include "cases/cli/progress/durations.h"
#include "cases/cli/progress/measured_times.h"

namespace rigor::inline cli {
namespace {

constexpr double kPerSolvedTruth = 1, kPerClosedForm = 0.05;  // s
constexpr double kTimingAndTwin = 2;                          // a run of everything runs each cell again
constexpr double kSpreadOfGuess = 4;                          // of a guess; of the sum of measured times
constexpr double kSpread = 1.5;

bool is_run(const Cell& cell) { return cell.status != Status::unsupported; }

double seconds_of_truth(const std::string& truth) {
  if (truth == "none") return 0;
  return truth == "reference" || truth == "events" ? kPerSolvedTruth : kPerClosedForm;
}

std::string in_words(const Estimate& estimate) {
  constexpr double kMoment = 2;  // s
  return estimate.most < kMoment ? "a moment" : duration_range(estimate.least, estimate.most);
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

Estimate estimated_seconds(const Results& planned, const GridRequest& asked) {
  const bool is_everything = !asked.is_gate;
  const MeasuredTimes measured = measured_times(asked.out.dir);
  double known = 0, guessed = 0;
  for (const CaseResult& result : planned.cases) {
    guessed += seconds_of_truth(result.definition.truth);
    for (const Cell& cell : result.cells) {
      if (!is_run(cell)) continue;
      const auto before = measured.find({result.definition.id, planned.runs[cell.run].text, cell.dt.text});
      if (before != measured.end()) {
        known += before->second;
      } else {
        guessed += std::min(predicted_seconds(result.definition, cell) * (is_everything ? kTimingAndTwin : 1),
                            asked.timeout.seconds);
      }
    }
    if (!is_everything) continue;
    const auto searches =
        std::count_if(result.stable_steps.begin(), result.stable_steps.end(),
                      [](const StableStepResult& stable) { return stable.status != Status::unsupported; });
    guessed += predicted_search_seconds(result.definition.scene) * static_cast<double>(searches);
  }
  return {(known / kSpread + guessed / kSpreadOfGuess) / asked.jobs.count,
          (known * kSpread + guessed * kSpreadOfGuess) / asked.jobs.count};
}

std::string plan_sentence(const Results& planned, const GridRequest& asked) {
  std::size_t cells = 0, unsupported = 0;
  for (const CaseResult& result : planned.cases) {
    for (const Cell& cell : result.cells) ++(is_run(cell) ? cells : unsupported);
  }
  const std::string rest = unsupported > 0 ? fmt::format(", {} more unsupported", unsupported) : "";
  return fmt::format("{} by {}: {}{}; {} with {}; the reports will be in {}", counted(planned.cases.size(), "case"),
                     counted(planned.runs.size(), "run"), counted(cells, "cell"), rest,
                     in_words(estimated_seconds(planned, asked)),
                     counted(static_cast<std::size_t>(asked.jobs.count), "job"), asked.out.dir);
}

}  // namespace rigor::inline cli
