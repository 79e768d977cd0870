#include "cases/results/main_error.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline results {
namespace {

// Not a number where the cell has no such value.
double main_value_of(const Cell& cell, const std::string& name) {
  const auto found = cell.metrics.find(name);
  return found == cell.metrics.end() || !found->second.not_applicable.empty() ? std::nan("") : found->second.value;
}

double worst_of(const CaseResult& result, const std::string& name) {
  double worst = 0;
  for (const Cell& cell : result.cells) worst = std::max(worst, main_value_of(cell, name));  // ignores not-a-number
  return worst;
}

}  // namespace

std::string main_error(const CaseResult& result) {
  if (result.definition.truth == "recording")
    return worst_of(result, "mean_position_error") > 0 ? "mean_position_error" : "mean_rotation_error";
  constexpr double kMoves = 1e-9;  // m and rad: less is rounding
  for (const std::string& name : headline_metrics()) {
    if (worst_of(result, name) > kMoves) return name;
  }
  const bool has_truth = std::any_of(result.cells.begin(), result.cells.end(), [](const Cell& cell) {
    return !std::isnan(main_value_of(cell, "position_error"));
  });
  return has_truth && worst_of(result, "energy_drift") < kMoves ? "position_error" : "energy_drift_synchronised";
}

}  // namespace rigor::inline results
