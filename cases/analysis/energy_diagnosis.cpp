#include "cases/analysis/energy_diagnosis.h"

#include <cmath>

#include "cases/metrics/measures/energy_series.h"

namespace rigor::inline analysis {
namespace {

constexpr double kNotableDrift = 0.01;  // of the largest kinetic energy

void add_drift(const CaseResult& result, const Cell& cell, std::vector<Diagnosis>& all) {
  constexpr double kGone = 0.1;
  const Verdict verdict = cell.stability.verdict;
  const double drift = signed_value(cell.metrics, "energy_drift");
  if (verdict != Verdict::drifting && verdict != Verdict::gaining) return;
  if (may_change_energy(result.definition.scene) || !(std::abs(drift) > kNotableDrift)) return;
  const double without = signed_value(cell.scheme.without_gyroscopic_term, "energy_drift");
  const bool is_gyroscopic = std::abs(without) < kGone * std::abs(drift);
  all.push_back({.topic = kEnergyDrifts,
                 .runs = {cell.run},
                 .of_case = result.definition.id,
                 .value = drift,
                 .cause = is_gyroscopic ? kGyroscopicTerm : "",
                 .worst = cell.metrics.at("energy_drift").worst,
                 .beside = signed_value(cell.scheme.metrics, "energy_drift")});
}

void add_misread(const CaseResult& result, const Cell& cell, std::vector<Diagnosis>& all) {
  const double raw = std::abs(signed_value(cell.metrics, "energy_drift")),
               synchronised = std::abs(signed_value(cell.metrics, "energy_drift_synchronised"));
  if (cell.stability.verdict == Verdict::blown_up || !(synchronised < kNotableDrift) || !(raw > kNotableDrift)) return;
  all.push_back({.topic = kEnergyMisread,
                 .runs = {cell.run},
                 .of_case = result.definition.id,
                 .value = raw,
                 .worst = cell.metrics.at("energy_drift").worst,
                 .beside = synchronised});
}

}  // namespace

std::vector<Diagnosis> energy_diagnoses(const CaseResult& result, const StepSize& dt) {
  std::vector<Diagnosis> all;
  for (const Cell& cell : result.cells) {
    if (!(cell.dt == dt) || cell.metrics.empty()) continue;
    add_drift(result, cell, all), add_misread(result, cell, all);
  }
  return all;
}

double signed_value(const std::map<std::string, MetricValue>& metrics, const std::string& name) {
  const auto found = metrics.find(name);
  if (found == metrics.end() || !found->second.not_applicable.empty()) return std::nan("");
  const MetricValue& metric = found->second;
  return std::copysign(metric.value, metric.worst.found - metric.worst.expected);
}

}  // namespace rigor::inline analysis
