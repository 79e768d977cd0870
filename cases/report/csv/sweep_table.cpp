#include "cases/report/csv/sweep_table.h"

#include <fmt/format.h>

#include <cmath>

#include "cases/metrics/metric.h"
#include "cases/report/csv/trajectory_csv.h"
#include "cases/results/result_json.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

// The step has a separate column.
bool has_column(const SweepAxis& axis) { return axis.kind != SweepAxis::Kind::step; }

Json json_of_value(const std::string& value) {
  const double number = number_in(value);
  return std::isnan(number) ? Json(value) : Json(number);
}

}  // namespace

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

std::string sweep_csv_header(const Sweep& sweep) {
  std::string line = "case,engine,dt [s]";
  for (const SweepAxis& axis : sweep.axes()) {
    if (has_column(axis)) line += "," + csv_field(with_unit(axis.key, unit_of_axis(axis)));
  }
  line += ",status,verdict";
  for (const std::string& metric : sweep.metrics()) line += "," + with_unit(metric, unit_of_metric(metric));
  return line + ",reason,held_to_itself\n";
}

std::string sweep_csv_row(const Sweep& sweep, const SweepRow& row) {
  std::string line = fmt::format("{},{},{}", csv_field(sweep.cases()[row.of_case].id),
                                 csv_field(sweep.runs()[row.run].text), row.dt.seconds);
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    if (has_column(sweep.axes()[i])) line += "," + csv_field(row.values[i]);
  }
  line += fmt::format(",{},{}", word_of(row.status), row.verdict);
  for (const double value : row.metrics) line += std::isnan(value) ? "," : fmt::format(",{}", value);
  return line + fmt::format(",{},{}\n", csv_field(row.reason), fmt::join(row.held_to_itself, " "));
}

std::string sweep_json_row(const Sweep& sweep, const SweepRow& row) {
  Json json = {{"case", sweep.cases()[row.of_case].id}, {"engine", sweep.runs()[row.run].text}, {"dt", row.dt.seconds}};
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    if (has_column(sweep.axes()[i])) json[sweep.axes()[i].key] = json_of_value(row.values[i]);
  }
  json["status"] = word_of(row.status);
  json["verdict"] = row.verdict.empty() ? Json(nullptr) : Json(row.verdict);
  for (std::size_t i = 0; i < row.metrics.size(); ++i)
    json[sweep.metrics()[i]] = std::isnan(row.metrics[i]) ? Json(nullptr) : Json(row.metrics[i]);
  json["reason"] = row.reason;
  json["held_to_itself"] = row.held_to_itself;
  return text_of(std::move(json), -1) + "\n";
}

}  // namespace rigor::inline report
