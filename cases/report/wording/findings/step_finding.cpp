#include "cases/report/wording/findings/step_finding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "cases/analysis/frontier.h"
#include "cases/report/wording/recommendation.h"
#include "cases/report/wording/wording.h"

namespace rigor::inline report {
namespace {

// The largest step that a run may take, by the rule of the recommendation.
struct RunStep {
  std::size_t run;
  bool is_reference;
  std::optional<StepSize> step;
  double seconds() const { return step ? step->seconds : 0; }
};

std::vector<RunStep> steps_of(const Results& results, const RunNames& names) {
  std::vector<RunStep> steps;
  for (const Frontier& frontier : frontiers(results)) {
    if (names.is_common(frontier.run))
      steps.push_back({frontier.run, frontier.is_reference, largest_step_within(frontier, kRecommendedTolerance)});
  }
  std::stable_sort(steps.begin(), steps.end(),
                   [](const RunStep& a, const RunStep& b) { return b.seconds() < a.seconds(); });
  return steps;
}

class StepFinding {
 public:
  StepFinding(const Results& results, const RunNames& names) : names_(names), steps_(steps_of(results, names)) {}

  std::optional<Finding> finding() {
    if (steps_.empty()) return std::nullopt;
    std::vector<std::string> parts;
    if (std::string others = list(false, false); !others.empty()) parts.push_back(std::move(others));
    if (std::string best = best_of_core(); !best.empty()) parts.push_back(std::move(best));
    if (std::string reference = list(true, true); !reference.empty())
      parts.push_back("adaptive reference: " + reference);
    std::string more =
        "At this step the typical error over the cases is within 1 mm, or 1 mrad where nothing moves away. No more "
        "than one case in twenty fails.";
    if (const std::string all = list(true, false); !all.empty()) more += fmt::format(" Core methods: {}.", all);
    return Finding{"step size", fmt::format("Largest step within 1 mm: {}.", fmt::join(parts, "; ")), more,
                   claims_.take()};
  }

 private:
  std::string step_text(const RunStep& step) {
    const std::string dt = step.step ? step.step->text : "";
    claims_.state({"largest step for a tolerance", "", names_.of(step.run), dt, "0.001", step.seconds()});
    return step.step ? dt + " s" : "none";
  }

  // Every such run with its step.
  std::string list(bool is_core, bool is_reference) {
    std::vector<std::string> all;
    for (const RunStep& step : steps_) {
      if (names_.is_ours(step.run) == is_core && step.is_reference == is_reference)
        all.push_back(fmt::format("{} {}", names_.of(step.run), step_text(step)));
    }
    return fmt::format("{}", fmt::join(all, ", "));
  }

  // The core's methods with the longest step. All of a tie are named, or counted.
  std::string best_of_core() {
    std::vector<const RunStep*> ours;
    for (const RunStep& step : steps_) {
      if (names_.is_ours(step.run) && !step.is_reference) ours.push_back(&step);
    }
    if (ours.empty()) return "";
    const double longest = ours.front()->seconds();
    const auto tied = static_cast<std::size_t>(
        std::count_if(ours.begin(), ours.end(), [&](const RunStep* step) { return step->seconds() == longest; }));
    const std::string count = ours.size() == 1 ? "" : fmt::format("best of {} core methods: ", counted(ours.size()));
    if (longest == 0) return ours.size() == 1 ? names_.of(ours[0]->run) + " none" : count + "none";
    std::vector<std::string> best;
    for (std::size_t n = 0; n < std::min(tied, RunNames::kFewOfOurs); ++n) best.push_back(names_.of(ours[n]->run));
    const std::string others = tied > best.size() ? fmt::format(" and {} more", counted_tie(tied - best.size())) : "";
    return fmt::format("{}{}{} {}", count, fmt::join(best, ", "), others, step_text(*ours[0]));
  }

  std::string counted(std::size_t count) {
    return claims_.count({"core methods with an error", "", "", "", "0.001", static_cast<double>(count)});
  }
  std::string counted_tie(std::size_t count) {
    return claims_.count(
        {"core methods that share the best step, not named", "", "", "", "0.001", static_cast<double>(count)});
  }

  const RunNames& names_;
  std::vector<RunStep> steps_;
  Claims claims_;
};

}  // namespace

std::optional<Finding> step_finding(const Results& results, const RunNames& names) {
  if (nothing_moves(results)) return Finding{"step size", nothing_moves_text(results), "", {}};
  return StepFinding(results, names).finding();
}

}  // namespace rigor::inline report
