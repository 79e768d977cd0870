#include "cases/analysis/step_needed.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cases/analysis/cell_error.h"

namespace rigor::inline analysis {
namespace {

struct ErrorAtStep {
  StepSize dt;
  double error;  // infinite if the cell failed
};

// Steps from the coarsest to the finest.
std::vector<ErrorAtStep> errors_at_steps(const CaseResult& result, std::size_t run, const std::string& metric) {
  std::vector<ErrorAtStep> errors;
  for (const Cell& cell : result.cells) {
    if (cell.run != run) continue;
    const MainErrorOfCell one = main_error_of(result, cell, metric);
    if (one.kind != MainErrorOfCell::Kind::none) errors.push_back({cell.dt, one.value});
  }
  std::stable_sort(errors.begin(), errors.end(),
                   [](const auto& a, const auto& b) { return a.dt.seconds > b.dt.seconds; });
  return errors;
}

double slope_between(const ErrorAtStep& coarse, const ErrorAtStep& fine) {
  return std::log(coarse.error / fine.error) / std::log(coarse.dt.seconds / fine.dt.seconds);
}

double on_line(const ErrorAtStep& from, double slope, double error) {
  return from.dt.seconds * std::pow(error / from.error, 1 / slope);
}

StepNeeded beyond_finest(const std::vector<ErrorAtStep>& errors, double tolerance) {
  constexpr double kFurthest = 30, kFalls = 0.5;  // order
  if (errors.size() < 2) return {};
  const ErrorAtStep &coarse = errors[errors.size() - 2], &finest = errors.back();
  if (!std::isfinite(coarse.error) || !std::isfinite(finest.error)) return {};
  const double slope = slope_between(coarse, finest);
  if (!(slope >= kFalls)) return {};
  const double seconds = on_line(finest, slope, tolerance);
  if (!(seconds * kFurthest >= finest.dt.seconds)) return {};
  return {StepNeeded::Found::beyond, seconds};
}

}  // namespace

std::string word_of(StepNeeded::Found found) {
  using enum StepNeeded::Found;
  return found == none ? "none" : found == beyond ? "beyond" : found == between ? "between" : "tried";
}

std::optional<StepNeeded> step_needed(const CaseResult& result, std::size_t run, const std::string& metric,
                                      double tolerance) {
  const std::vector<ErrorAtStep> errors = errors_at_steps(result, run, metric);
  if (errors.empty()) return {};
  std::size_t first = errors.size();  // from here on all keep the tolerance
  while (first > 0 && errors[first - 1].error <= tolerance) --first;
  if (first == errors.size()) return beyond_finest(errors, tolerance);
  const ErrorAtStep& keeps = errors[first];
  const bool is_coarsest = first == 0 && keeps.dt == coarsest_dt(result);
  if (first == 0 || !std::isfinite(errors[first - 1].error) || !(keeps.error > 0))
    return StepNeeded{StepNeeded::Found::tried, keeps.dt.seconds, is_coarsest};
  return StepNeeded{StepNeeded::Found::between, on_line(keeps, slope_between(errors[first - 1], keeps), tolerance)};
}

std::vector<StepOverCases> steps_over_cases(const Results& results, double tolerance) {
  std::vector<std::pair<const CaseResult*, std::string>> judged;  // with the main error
  for (const CaseResult& result : results.cases) {
    if (has_main_error_of_truth(result)) judged.emplace_back(&result, main_error(result));
  }
  std::vector<StepOverCases> all;
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    std::vector<StepNeeded> steps;
    for (const auto& [result, metric] : judged) {
      const auto step = step_needed(*result, run, metric, tolerance);
      if (step) steps.push_back(*step);
    }
    if (steps.empty() || 2 * steps.size() < judged.size()) continue;
    std::stable_sort(steps.begin(), steps.end());
    const auto failed = static_cast<std::size_t>(std::count_if(
        steps.begin(), steps.end(), [](const StepNeeded& step) { return step.found == StepNeeded::Found::none; }));
    all.push_back({run, is_reference_method(results, run), steps.size(), failed, steps[(steps.size() - 1) / 2]});
  }
  return all;
}

}  // namespace rigor::inline analysis
