#include "cases/analysis/work_precision.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/analysis/cell_error.h"

namespace rigor::inline analysis {
namespace {

// log error at log cost, on the straight line through two points.
double on_line(const ErrorPoint& a, const ErrorPoint& b, double cost) {
  const double run = std::log(b.cost / a.cost);
  if (run == 0) return std::min(a.error, b.error);
  return std::exp(std::log(a.error) + std::log(b.error / a.error) * std::log(cost / a.cost) / run);
}

std::optional<AtCost> extrapolated(const std::vector<ErrorPoint>& points, double cost, double largest_stable_dt) {
  constexpr double kFurthest = 4;  // times the longest step
  const ErrorPoint& first = points.front();
  const double stretch = first.cost / cost;
  if (points.size() < 2 || stretch > kFurthest || stretch * first.dt.seconds > largest_stable_dt) return {};
  return AtCost{on_line(first, points[1], cost), Reach::extrapolated};
}

// 0 where it is not known.
double stable_dt(const CaseResult& result, std::size_t run) {
  if (run >= result.stable_steps.size()) return 0;
  const StableStepResult& stable = result.stable_steps[run];
  return stable.status == Status::pass ? stable.step.dt : 0;
}

}  // namespace

std::string word_of(Reach reach) {
  return reach == Reach::interpolated ? "interpolated" : reach == Reach::extrapolated ? "extrapolated" : "at most";
}

std::optional<AtCost> error_at_cost(std::vector<ErrorPoint> points, double cost, double largest_stable_dt) {
  if (points.empty()) return {};
  std::sort(points.begin(), points.end(), [](const ErrorPoint& a, const ErrorPoint& b) { return a.cost < b.cost; });
  if (cost < points.front().cost) return extrapolated(points, cost, largest_stable_dt);
  if (cost > points.back().cost) return AtCost{points.back().error, Reach::at_most};
  std::size_t i = 1;
  while (i < points.size() && points[i].cost < cost) ++i;
  if (i == points.size()) return AtCost{points.front().error, Reach::interpolated};  // the only point, at its very cost
  return AtCost{on_line(points[i - 1], points[i], cost), Reach::interpolated};
}

std::vector<std::size_t> baselines(const Results& results) {
  std::vector<std::size_t> found;
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    if (!is_in_house(results, run) && results.runs[run].settings.track == Track::matched) found.push_back(run);
  }
  return found;
}

std::vector<EqualCost> at_equal_cost(const CaseResult& result, std::size_t run, std::size_t baseline,
                                     const std::string& metric) {
  const auto points = error_points(result, run, metric);
  std::vector<EqualCost> out;
  for (const ErrorPoint& point : error_points(result, baseline, metric)) {
    out.push_back({run, baseline, point, error_at_cost(points, point.cost, stable_dt(result, run))});
  }
  return out;
}

std::size_t BestOfCore::compared() const {
  return std::count_if(points.begin(), points.end(), [](const EqualCost& point) { return point.of_run.has_value(); });
}

double BestOfCore::mean() const {
  double logs = 0;
  for (const EqualCost& point : points) logs += point.of_run ? std::log(point.times_less()) : 0;
  return std::exp(logs / static_cast<double>(compared()));
}

double BestOfCore::least() const {
  double least = std::numeric_limits<double>::infinity();
  for (const EqualCost& point : points) {
    if (point.of_run) least = std::min(least, point.times_less());
  }
  return least;
}

std::optional<BestOfCore> best_of_core(const Results& results, const CaseResult& result, std::size_t baseline,
                                       const std::string& metric) {
  std::optional<BestOfCore> best;
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    if (!is_in_house(results, run) || is_reference_method(results, run)) continue;
    const BestOfCore here{metric, at_equal_cost(result, run, baseline, metric)};
    if (here.compared() == 0) continue;
    const bool is_better = !best || here.compared() > best->compared() ||
                           (here.compared() == best->compared() && here.mean() > best->mean());
    if (is_better) best = here;
  }
  return best;
}

}  // namespace rigor::inline analysis
