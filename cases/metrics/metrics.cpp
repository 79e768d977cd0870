#include "cases/metrics/metric.h"

namespace rigor {

// One declaration and one row a metric, alphabetical; each is defined in the file of its name.
MetricRow angular_momentum_drift();
MetricRow energy_drift();
MetricRow energy_drift_synchronised();
MetricRow linear_momentum_drift();
MetricRow orientation_error();
MetricRow orthonormality_error();
MetricRow position_error();
MetricRow unexplained_error();
MetricRow unexplained_rotation();

const std::vector<MetricRow>& metrics() {
  static const std::vector<MetricRow> table = {
      angular_momentum_drift(), energy_drift(),      energy_drift_synchronised(),
      linear_momentum_drift(),  orientation_error(), orthonormality_error(),
      position_error(),         unexplained_error(), unexplained_rotation(),
  };
  return table;
}

}  // namespace rigor
