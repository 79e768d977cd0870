#include "cases/analysis/cell_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/results/observed_order.h"

namespace rigor::inline analysis {
namespace {

const MetricValue* metric_in(const Cell& cell, const std::string& name) {
  const auto found = cell.metrics.find(name);
  return found == cell.metrics.end() || !found->second.not_applicable.empty() ? nullptr : &found->second;
}

}  // namespace

bool has_main_error_of_truth(const CaseResult& result) {
  // A recording's errors are means in percent and degrees, which no tolerance in m or rad fits.
  return result.definition.truth != "recording" && !main_error(result).starts_with("energy");
}

StepSize matrix_dt(const CaseResult& result, const StepSize& headline) {
  const auto& steps = result.definition.dt;
  const auto own = std::find(steps.begin(), steps.end(), headline);
  return own != steps.end() ? *own : coarsest_dt(result);
}

MainErrorOfCell main_error_of(const CaseResult& result, const Cell& cell, const std::string& metric) {
  using enum MainErrorOfCell::Kind;
  if (cell.status == Status::unsupported) return {};
  const MetricValue* error = metric_in(cell, metric);
  if (error && error->is_held_to_itself) return {};
  const bool blew_up = !cell.metrics.empty() && cell.stability.verdict == Verdict::blown_up;
  if (!came_to_a_result(cell) || blew_up || (error && !std::isfinite(error->value)))
    return {failed, std::numeric_limits<double>::infinity()};
  if (!error) return {};
  return {value, std::max(error->value, metric.starts_with("energy") ? 0 : error_floor(result))};
}

bool is_wrong_as_a_whole(const Cell& cell) {
  return !cell.metrics.empty() && cell.stability.verdict != Verdict::stable &&
         cell.stability.verdict != Verdict::drifting;
}

bool is_reference_method(const Results& results, std::size_t run) {
  const RunName& name = results.runs[run];
  for (const EngineInfo& engine : results.engines) {
    if (engine.name == name.engine) return engine.is_in_house && method_of(engine, name.settings).adaptive;
  }
  return false;
}

}  // namespace rigor::inline analysis
