#include "cases/cli/plan_sentence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rigor {
namespace {

// Measured over the suite, a step of all its metrics included: what differs is engines, by ten and more, and cases.
constexpr double kPerBodyStep = 3e-6;                             // s
constexpr double kPerJointedStep = 6e-6, kPerJointedBody = 4e-6;  // s, of a step, and of each body in it
constexpr double kPerCell = 0.03;                                 // s
constexpr double kPerSearch = 0.1, kPerSearchWithLimits = 0.4;    // s, for a stable step
constexpr double kPerSolvedTruth = 1, kPerClosedForm = 0.05;      // s
constexpr double kTimingAndTwin = 2;                              // a run of everything runs each cell again

bool is_run(const Cell& cell) { return cell.status != Status::unsupported; }

double seconds_of(const Case& definition, const Cell& cell) {
  const double steps = definition.duration / cell.dt.seconds,
               bodies = static_cast<double>(definition.scene.bodies.size());
  const double per_step =
      definition.scene.joints.empty() ? bodies * kPerBodyStep : kPerJointedStep + bodies * kPerJointedBody;
  return kPerCell + steps * per_step;
}

double seconds_of_search(const Scene& scene) {
  const bool has_limits =
      std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) { return joint.has_limits(); });
  return has_limits ? kPerSearchWithLimits : kPerSearch;
}

double seconds_of_truth(const std::string& truth) {
  if (truth == "none") return 0;
  return truth == "reference" || truth == "events" ? kPerSolvedTruth : kPerClosedForm;
}

std::string in_words(double seconds) {
  if (seconds < 2) return "a moment";
  if (seconds < 90)
    return fmt::format("about {:.0f} s", seconds < 10 ? std::ceil(seconds) : 10 * std::ceil(seconds / 10));
  return fmt::format("about {:.0f} minutes", std::ceil(seconds / 60));
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

double estimated_seconds(const Results& planned, const CommandLine& line) {
  const bool is_everything = line.command == "run";
  double all = 0;
  for (const CaseResult& result : planned.cases) {
    all += seconds_of_truth(result.definition.truth);
    for (const Cell& cell : result.cells) {
      if (is_run(cell))
        all += std::min(seconds_of(result.definition, cell) * (is_everything ? kTimingAndTwin : 1), line.limit);
    }
    if (!is_everything) continue;
    const auto searches =
        std::count_if(result.stable_steps.begin(), result.stable_steps.end(),
                      [](const StableStepResult& stable) { return stable.status != Status::unsupported; });
    all += seconds_of_search(result.definition.scene) * static_cast<double>(searches);
  }
  return all / line.jobs;
}

std::string plan_sentence(const Results& planned, const CommandLine& line) {
  std::size_t cells = 0, unsupported = 0;
  for (const CaseResult& result : planned.cases) {
    for (const Cell& cell : result.cells) ++(is_run(cell) ? cells : unsupported);
  }
  const std::string rest = unsupported > 0 ? fmt::format(", {} more unsupported", unsupported) : "";
  return fmt::format("{} by {}: {}{}; {} with {}; the reports will be in {}", counted(planned.cases.size(), "case"),
                     counted(planned.runs.size(), "run"), counted(cells, "cell"), rest,
                     in_words(estimated_seconds(planned, line)), counted(static_cast<std::size_t>(line.jobs), "job"),
                     line.out);
}

}  // namespace rigor
