#include "cases/report/wording/findings/step_finding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "cases/analysis/step_needed.h"
#include "cases/report/wording/wording.h"

namespace rigor {
namespace {

constexpr double kMillimetre = 1e-3;  // m, or rad

class StepFinding {
 public:
  StepFinding(const Results& results, const RunNames& names)
      : names_(names), steps_(steps_over_cases(results, kMillimetre)) {
    std::stable_sort(steps_.begin(), steps_.end(),
                     [](const auto& a, const auto& b) { return b.median.seconds < a.median.seconds; });
  }

  std::optional<Finding> finding() {
    if (steps_.empty()) return std::nullopt;
    std::vector<std::string> parts, core;
    if (std::string others = list(false, false); !others.empty()) parts.push_back(std::move(others));
    if (std::string best = best_of_core(); !best.empty()) parts.push_back(std::move(best));
    if (std::string reference = list(true, true); !reference.empty())
      parts.push_back("adaptive reference: " + reference);
    std::string more =
        "The step keeps the median case within 1 mm of the truth, or 1 mrad where nothing moves away. A blow-up counts "
        "as a failed case. ~ lies below the steps that were tried.";
    if (const std::string all = list(true, false); !all.empty()) more += fmt::format(" Core methods: {}.", all);
    return Finding{"step size", fmt::format("Median step for 1 mm: {}.", fmt::join(parts, "; ")), more, claims_.take()};
  }

 private:
  std::string step_text(const StepOverCases& step) {
    Claim claim{"median step for a tolerance", "", names_.of(step.run), "", "0.001", step.median.seconds};
    if (step.median.found == StepNeeded::Found::none) {
      claims_.state(claim);
      return "none";
    }
    const std::string mark = step.median.is_coarsest ? "≥ " : step.median.found == StepNeeded::Found::beyond ? "~" : "";
    return mark + claims_.quantity(claim, "s");
  }

  // Every such run with its step.
  std::string list(bool is_core, bool is_reference) {
    std::vector<std::string> all;
    for (const StepOverCases& step : steps_) {
      if (names_.is_ours(step.run) == is_core && step.is_reference == is_reference)
        all.push_back(fmt::format("{} {}", names_.of(step.run), step_text(step)));
    }
    return fmt::format("{}", fmt::join(all, ", "));
  }

  // The core's methods with the longest step. All of a tie are named, or counted.
  std::string best_of_core() {
    constexpr double kTie = 1e-9;  // relative
    std::vector<const StepOverCases*> ours;
    for (const StepOverCases& step : steps_) {
      if (names_.is_ours(step.run) && !step.is_reference) ours.push_back(&step);
    }
    if (ours.empty()) return "";
    const double longest = ours.front()->median.seconds;
    const auto tied = static_cast<std::size_t>(std::count_if(
        ours.begin(), ours.end(), [&](const auto* step) { return step->median.seconds >= (1 - kTie) * longest; }));
    const std::string count = ours.size() == 1 ? "" : fmt::format("best of {} core methods: ", counted(ours.size()));
    if (longest == 0) return ours.size() == 1 ? names_.of(ours[0]->run) + " none" : count + "none";
    std::vector<std::string> best;
    for (std::size_t n = 0; n < std::min(tied, RunNames::kFewOfOurs); ++n) best.push_back(names_.of(ours[n]->run));
    const std::string others = tied > best.size() ? fmt::format(" and {} more", counted_tie(tied - best.size())) : "";
    return fmt::format("{}{}{} {}", count, fmt::join(best, ", "), others, step_text(*ours[0]));
  }

  std::string counted(std::size_t count) {
    return claims_.count({"core methods with a median step", "", "", "", "0.001", static_cast<double>(count)});
  }
  std::string counted_tie(std::size_t count) {
    return claims_.count(
        {"core methods that share the best step, not named", "", "", "", "0.001", static_cast<double>(count)});
  }

  const RunNames& names_;
  std::vector<StepOverCases> steps_;
  Claims claims_;
};

}  // namespace

std::optional<Finding> step_finding(const Results& results, const RunNames& names) {
  return StepFinding(results, names).finding();
}

}  // namespace rigor
