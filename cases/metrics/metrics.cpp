#include "cases/metrics/metric.h"

#include <algorithm>

namespace rigor::inline metric {

// One declaration and one row a metric, alphabetical; each is defined in the file of its name.
MetricRow angular_momentum_drift();
MetricRow angular_velocity_error();
MetricRow centre_of_pressure_error();
MetricRow collapse_time();
MetricRow contact_balance();
MetricRow contact_force_error();
MetricRow contact_gap_error();
MetricRow contact_moment_error();
MetricRow cost();
MetricRow coulomb_residual();
MetricRow creep();
MetricRow dissipation_residual();
MetricRow energy_drift();
MetricRow energy_drift_synchronised();
MetricRow energy_gain();
MetricRow ensemble_distance();
MetricRow ensemble_p_value();
MetricRow force_peak();
MetricRow force_ripple();
MetricRow friction_anisotropy();
MetricRow hover();
MetricRow impact_time_error();
MetricRow internal_energy_drift();
MetricRow joint_gap();
MetricRow joint_gap_rate();
MetricRow joint_twist();
MetricRow joint_twist_rate();
MetricRow linear_momentum_drift();
MetricRow mean_position_error();
MetricRow mean_rotation_error();
MetricRow orientation_error();
MetricRow orthonormality_error();
MetricRow penetration();
MetricRow phase_error();
MetricRow position_error();
MetricRow reaction_error();
MetricRow reaction_torque_error();
MetricRow repeats();
MetricRow reported_reaction_error();
MetricRow reported_reaction_torque_error();
MetricRow restitution_error();
MetricRow signorini_residual();
MetricRow stop_distance_error();
MetricRow survival();
MetricRow tube();
MetricRow unexplained_error();
MetricRow unexplained_rotation();
MetricRow unexplained_spin();
MetricRow unexplained_velocity();
MetricRow velocity_error();

const std::vector<MetricRow>& metrics() {
  static const std::vector<MetricRow> table = {
      angular_momentum_drift(),
      angular_velocity_error(),
      centre_of_pressure_error(),
      collapse_time(),
      contact_balance(),
      contact_force_error(),
      contact_gap_error(),
      contact_moment_error(),
      cost(),
      coulomb_residual(),
      creep(),
      dissipation_residual(),
      energy_drift(),
      energy_drift_synchronised(),
      energy_gain(),
      ensemble_distance(),
      ensemble_p_value(),
      force_peak(),
      force_ripple(),
      friction_anisotropy(),
      hover(),
      impact_time_error(),
      internal_energy_drift(),
      joint_gap(),
      joint_gap_rate(),
      joint_twist(),
      joint_twist_rate(),
      linear_momentum_drift(),
      mean_position_error(),
      mean_rotation_error(),
      orientation_error(),
      orthonormality_error(),
      penetration(),
      phase_error(),
      position_error(),
      reaction_error(),
      reaction_torque_error(),
      repeats(),
      reported_reaction_error(),
      reported_reaction_torque_error(),
      restitution_error(),
      signorini_residual(),
      stop_distance_error(),
      survival(),
      tube(),
      unexplained_error(),
      unexplained_rotation(),
      unexplained_spin(),
      unexplained_velocity(),
      velocity_error(),
  };
  return table;
}

const MetricRow* find_metric(const std::string& name) {
  const auto row = std::find_if(metrics().begin(), metrics().end(), [&](const auto& one) { return one.name == name; });
  return row == metrics().end() ? nullptr : &*row;
}

std::vector<std::string> metrics_that_need(bool MetricNeeds::*need) {
  std::vector<std::string> names;
  for (const MetricRow& row : metrics())
    if (row.needs.*need) names.push_back(row.name);
  return names;
}

const std::vector<std::string>& headline_metrics() {
  static const std::vector<std::string> names = [] {
    std::map<int, std::string> ranked;
    for (const MetricRow& row : metrics())
      if (row.headline > 0) ranked[row.headline] = row.name;
    std::vector<std::string> found;
    for (const auto& [rank, name] : ranked) found.push_back(name);
    return found;
  }();
  return names;
}

const std::vector<CrossMetricRow>& cross_metrics() {
  static const std::vector<CrossMetricRow> table = {
      {"observed_order", "1",
       "the power of dt by which a run's position error falls, or its orientation error where nothing moves"},
      {"spread", "m", "largest distance between two runs of the same dt; a gate holds each pair of its engines to it"},
      {"spread_orientation", "rad", "likewise, the largest angle between two runs"},
  };
  return table;
}

std::string unit_of_metric(const std::string& name) {
  if (const MetricRow* row = find_metric(name)) return row->unit;
  for (const CrossMetricRow& row : cross_metrics()) {
    if (row.name == name) return row.unit;
  }
  return "";
}

}  // namespace rigor::inline metric
