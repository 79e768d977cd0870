#include "cases/analysis/relative_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cases/analysis/cell_error.h"

namespace rigor::inline analysis {
namespace {

// The larger of the two in the middle of an even count.
double worse_median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// By run; nothing where a run has no such error.
std::vector<std::optional<double>> errors_of(const Results& results, const CaseResult& result, const StepSize& dt) {
  const std::string metric = main_error(result);
  std::vector<std::optional<double>> errors(results.runs.size());
  for (const Cell& cell : result.cells) {
    if (!(cell.dt == dt)) continue;
    const MainErrorOfCell one = main_error_of(result, cell, metric);
    if (one.kind != MainErrorOfCell::Kind::none) errors[cell.run] = one.value;
  }
  return errors;
}

}  // namespace

std::vector<RelativeError> relative_errors(const Results& results, const StepSize& dt) {
  constexpr double kLeast = 1e-6;  // a ratio below it is rounding beside an error
  std::vector<std::vector<double>> ratios(results.runs.size());
  for (const CaseResult& result : results.cases) {
    const auto errors = errors_of(results, result, matrix_dt(result, dt));
    std::vector<double> choices;
    for (std::size_t run = 0; run < errors.size(); ++run) {
      if (errors[run] && !is_reference_method(results, run)) choices.push_back(*errors[run]);
    }
    if (choices.empty()) continue;
    const double median = worse_median(choices);
    if (!(median > 0)) continue;
    for (std::size_t run = 0; run < errors.size(); ++run) {
      if (!errors[run]) continue;
      ratios[run].push_back(std::isfinite(*errors[run]) ? std::max(*errors[run] / median, kLeast) : *errors[run]);
    }
  }
  std::vector<RelativeError> all;
  for (std::size_t run = 0; run < ratios.size(); ++run) {
    if (ratios[run].empty()) continue;
    const auto failed = static_cast<std::size_t>(
        std::count_if(ratios[run].begin(), ratios[run].end(), [](double ratio) { return !std::isfinite(ratio); }));
    all.push_back({run, ratios[run].size(), failed, worse_median(ratios[run])});
  }
  return all;
}

std::vector<StepSize> distinct_steps(const Results& results) {
  std::vector<StepSize> steps;
  for (const CaseResult& result : results.cases) {
    for (const StepSize& dt : result.definition.dt) {
      if (std::find(steps.begin(), steps.end(), dt) == steps.end()) steps.push_back(dt);
    }
  }
  std::stable_sort(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.seconds > b.seconds; });
  return steps;
}

}  // namespace rigor::inline analysis
