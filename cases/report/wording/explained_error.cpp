#include "cases/report/wording/explained_error.h"

#include <fmt/format.h>

#include "cases/report/wording/wording.h"

namespace rigor::inline report {
namespace {

std::string text_of(const std::map<std::string, MetricValue>& metrics, const std::string& name,
                    double MetricValue::*part = &MetricValue::value) {
  const auto found = metrics.find(name);
  return found == metrics.end() || !found->second.not_applicable.empty() ? "-" : rounded(found->second.*part);
}

ExplainedRow row_of(const std::string& engine, const Cell& cell) {
  return {engine,
          text_of(cell.metrics, "position_error"),
          text_of(cell.scheme.metrics, "position_error"),
          text_of(cell.metrics, "unexplained_error"),
          text_of(cell.metrics, "orientation_error"),
          text_of(cell.scheme.metrics, "orientation_error"),
          text_of(cell.metrics, "unexplained_rotation"),
          text_of(cell.metrics, "unexplained_rotation", &MetricValue::compared_until)};
}

}  // namespace

std::vector<ExplainedRow> explained_rows(const Results& results, const CaseResult& result, const StepSize& dt) {
  std::vector<ExplainedRow> rows;
  for (const Cell& cell : result.cells) {
    if (cell.dt != dt || cell.scheme.twin.empty()) continue;
    rows.push_back(row_of(results.runs[cell.run].text, cell));
  }
  return rows;
}

}  // namespace rigor::inline report
