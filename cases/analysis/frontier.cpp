#include "cases/analysis/frontier.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "cases/analysis/cell_error.h"

namespace rigor::inline analysis {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Outcome {
  double error;  // infinite if the cell failed
  double cost;   // 0 if it was not measured
};

// None where the cell says nothing about the run: it was not run, or there is no truth independent of it.
std::optional<Outcome> outcome_of(const CaseResult& result, const Cell& cell, const std::string& metric) {
  const MainErrorOfCell error = main_error_of(result, cell, metric);
  if (error.kind == MainErrorOfCell::Kind::none) return {};
  if (error.kind == MainErrorOfCell::Kind::failed || is_wrong_as_a_whole(cell)) return Outcome{kInfinity, 0};
  const auto cost = cell.metrics.find("cost");
  const bool is_timed = cost != cell.metrics.end() && cost->second.not_applicable.empty() && cost->second.value > 0;
  return Outcome{error.value, is_timed ? cost->second.value : 0};
}

// The smallest value that at least this share of them do not exceed.
double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

double larger_median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double geometric_mean(const std::vector<double>& values) {
  double logarithms = 0;
  for (const double value : values) logarithms += std::log(value);
  return values.empty() ? kInfinity : std::exp(logarithms / static_cast<double>(values.size()));
}

FrontierPoint point_of(const StepSize& dt, const std::vector<Outcome>& outcomes) {
  std::vector<double> all, finite, costs;
  for (const Outcome& outcome : outcomes) {
    all.push_back(outcome.error);
    if (std::isfinite(outcome.error)) finite.push_back(outcome.error);
    if (outcome.cost > 0) costs.push_back(outcome.cost);
  }
  FrontierPoint point{dt, all.size(), all.size() - finite.size()};
  point.mean = geometric_mean(finite);
  point.low = percentile(all, 0.1), point.high = percentile(all, 0.9);
  point.median = larger_median(all);
  point.cost = costs.empty() ? 0 : geometric_mean(costs);
  return point;
}

// A case that counts, and its main error, which takes a look at all its cells.
struct JudgedCase {
  const CaseResult* result;
  std::string metric;
};

std::vector<JudgedCase> judged_cases(const Results& results, const std::string& family) {
  std::vector<JudgedCase> judged;
  for (const CaseResult& result : results.cases) {
    if (!family.empty() && !result.definition.id.starts_with(family + "/")) continue;
    if (has_main_error_of_truth(result)) judged.push_back({&result, main_error(result)});
  }
  return judged;
}

std::vector<FrontierPoint> points_of(const std::vector<JudgedCase>& cases, std::size_t run) {
  std::map<double, std::pair<StepSize, std::vector<Outcome>>, std::greater<>> by_step;
  for (const auto& [result, metric] : cases) {
    for (const Cell& cell : result->cells) {
      if (cell.run != run) continue;
      const std::optional<Outcome> outcome = outcome_of(*result, cell, metric);
      if (!outcome) continue;
      auto& [dt, outcomes] = by_step[cell.dt.seconds];
      dt = cell.dt, outcomes.push_back(*outcome);
    }
  }
  std::vector<FrontierPoint> points;
  for (const auto& [seconds, at_step] : by_step) points.push_back(point_of(at_step.first, at_step.second));
  return points;
}

// Cases that the run cannot do. A cell that was only left out of the grid does not count.
std::size_t unsupported_cases(const Results& results, const std::string& family, std::size_t run) {
  const auto is_unsupported = [&](const Cell& cell) {
    return cell.run == run && cell.status == Status::unsupported && !cell.skipped;
  };
  return static_cast<std::size_t>(
      std::count_if(results.cases.begin(), results.cases.end(), [&](const CaseResult& result) {
        return (family.empty() || result.definition.id.starts_with(family + "/")) &&
               std::any_of(result.cells.begin(), result.cells.end(), is_unsupported);
      }));
}

bool is_candidate(const Results& results, const Frontier& frontier, Candidates candidates) {
  const bool is_core = is_in_house(results, frontier.run);
  switch (candidates) {
    case Candidates::engines:
      return !is_core;
    case Candidates::core_methods:
      return is_core && !frontier.is_reference;
    case Candidates::references:
      return frontier.is_reference;
  }
  return false;
}

std::size_t most_cases(const Frontier& frontier) {
  std::size_t most = 0;
  for (const FrontierPoint& point : frontier.points) most = std::max(most, point.cases);
  return most;
}

std::size_t most_cases(const std::vector<Frontier>& frontiers) {
  std::size_t most = 0;
  for (const Frontier& frontier : frontiers) most = std::max(most, most_cases(frontier));
  return most;
}

// Steps of few cases say nothing beside steps of many.
void leave_out_sparse_steps(std::vector<Frontier>& frontiers) {
  const std::size_t most = most_cases(frontiers);
  for (Frontier& frontier : frontiers) {
    const std::size_t own = most_cases(frontier), needed = 2 * own < most ? own : most;
    std::erase_if(frontier.points, [&](const FrontierPoint& point) { return 2 * point.cases < needed; });
  }
}

bool is_within(const FrontierPoint& point, double tolerance) {
  return std::max(point.mean, point.median) <= tolerance &&
         static_cast<double>(point.failed) <= kMostFailed * static_cast<double>(point.cases);
}

// What a point costs; where nothing was timed, how many steps it takes.
double work_of(const FrontierPoint& point, bool is_timed) { return is_timed ? point.cost : 1 / point.dt.seconds; }

bool is_any_timed(const std::vector<Frontier>& frontiers) {
  for (const Frontier& frontier : frontiers)
    for (const FrontierPoint& point : frontier.points)
      if (point.cost > 0) return true;
  return false;
}

}  // namespace

std::vector<Frontier> frontiers(const Results& results, const std::string& family) {
  const std::vector<JudgedCase> judged = judged_cases(results, family);
  std::vector<Frontier> all;
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    Frontier frontier{run, is_reference_method(results, run), unsupported_cases(results, family, run),
                      points_of(judged, run)};
    if (!frontier.points.empty()) all.push_back(std::move(frontier));
  }
  leave_out_sparse_steps(all);
  return all;
}

std::optional<StepSize> largest_step_within(const Frontier& frontier, double tolerance) {
  for (const FrontierPoint& point : frontier.points)
    if (is_within(point, tolerance)) return point.dt;
  return {};
}

std::optional<Choice> cheapest_within(const Results& results, const std::vector<Frontier>& frontiers, double tolerance,
                                      Candidates candidates) {
  const std::size_t most = most_cases(frontiers);
  const bool is_timed = is_any_timed(frontiers);
  std::optional<Choice> best;
  for (const Frontier& frontier : frontiers) {
    if (!is_candidate(results, frontier, candidates)) continue;
    for (const FrontierPoint& point : frontier.points) {
      if (!is_within(point, tolerance) || 2 * point.cases < most || (is_timed && !(point.cost > 0))) continue;
      if (!best || work_of(point, is_timed) < work_of(best->point, is_timed))
        best = Choice{frontier.run, point, frontier.unsupported};
    }
  }
  return best;
}

}  // namespace rigor::inline analysis
