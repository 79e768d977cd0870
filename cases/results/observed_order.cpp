#include "cases/results/observed_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/metrics/measures/measuring.h"

namespace rigor::inline results {
namespace {

const MetricValue* value_of(const Cell& cell, const std::string& metric) {
  const auto found = cell.metrics.find(metric);
  return found != cell.metrics.end() && found->second.not_applicable.empty() ? &found->second : nullptr;
}

// Of a cell whose steps were not timed the cost is 0.
std::vector<ErrorPoint> all_points(const CaseResult& result, std::size_t run, const std::string& metric) {
  std::vector<ErrorPoint> points;
  for (const Cell& cell : result.cells) {
    if (cell.run != run || !came_to_a_result(cell)) continue;
    const MetricValue *error = value_of(cell, metric), *cost = value_of(cell, "cost");
    if (!error || !std::isfinite(error->value)) continue;
    points.push_back({cell.dt, std::max(error->value, error_floor(result)), cost ? cost->value : 0});
  }
  return points;
}

}  // namespace

bool came_to_a_result(const Cell& cell) {
  return cell.status == Status::pass || cell.status == Status::fail || cell.status == Status::known_deviation ||
         cell.status == Status::unexpected_pass;
}

double fitted_order(const std::vector<double>& dt, const std::vector<double>& values) {
  double mean_x = 0, mean_y = 0, xy = 0, xx = 0;
  for (std::size_t i = 0; i < dt.size(); ++i) {
    mean_x += std::log(dt[i]) / dt.size();
    mean_y += std::log(values[i]) / dt.size();
  }
  for (std::size_t i = 0; i < dt.size(); ++i) {
    xy += (std::log(dt[i]) - mean_x) * (std::log(values[i]) - mean_y);
    xx += (std::log(dt[i]) - mean_x) * (std::log(dt[i]) - mean_x);
  }
  return xy / xx;
}

double error_floor(const CaseResult& result) {
  constexpr double kRoundings = 1e-14;  // m, rad
  const double of_truth = result.truth ? result.truth->error_at_end : 0;
  return std::max(kRoundings, std::min(of_truth, std::min(kTruthNeededPosition, kTruthNeededOrientation)));
}

std::vector<ErrorPoint> error_points(const CaseResult& result, std::size_t run, const std::string& metric) {
  const bool is_held_to_itself = std::any_of(result.cells.begin(), result.cells.end(), [&](const Cell& cell) {
    if (cell.run != run) return false;
    const MetricValue* error = value_of(cell, metric);
    return error && error->is_held_to_itself;
  });
  if (is_held_to_itself) return {};
  std::vector<ErrorPoint> points = all_points(result, run, metric);
  std::erase_if(points, [](const ErrorPoint& point) { return !(point.cost > 0); });
  return points;
}

std::vector<std::string> errors_worth_comparing(const CaseResult& result) {
  constexpr double kSameForAll = 1e-9;  // m, rad
  std::vector<std::string> worth;
  for (const std::string& metric : headline_metrics()) {
    const bool one_is_off = std::any_of(result.cells.begin(), result.cells.end(), [&](const Cell& cell) {
      const MetricValue* error = value_of(cell, metric);
      return came_to_a_result(cell) && error && error->value > kSameForAll;
    });
    if (one_is_off) worth.push_back(metric);
  }
  return worth;
}

ObservedOrder observed_order(const CaseResult& result, std::size_t run, const std::string& metric,
                             const std::function<bool(const StepSize&)>& selects) {
  ObservedOrder order;
  std::vector<double> dt, errors;
  for (const ErrorPoint& point : all_points(result, run, metric)) {
    if (!selects(point.dt) || point.error <= 100 * error_floor(result)) continue;
    dt.push_back(point.dt.seconds), errors.push_back(point.error);
    order.text += fmt::format("{}{:.4g} at {}", order.text.empty() ? "" : ", ", point.error, point.dt.text);
  }
  if (dt.size() < 2) return {{}, "fewer than two step sizes have an error that is the scheme's"};
  order.value = fitted_order(dt, errors);
  return order;
}

}  // namespace rigor::inline results
