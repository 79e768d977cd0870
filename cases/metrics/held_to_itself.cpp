#include "cases/metrics/held_to_itself.h"

#include "cases/case/recording/recording_reader.h"
#include "cases/metrics/metric.h"
#include "cases/truth/provenance.h"

namespace rigor::inline metric {

bool is_against_truth(const std::string& metric) {
  if (metric == "spread" || metric == "spread_orientation") return false;  // runs are compared with each other
  const MetricRow* row = find_metric(metric);
  return !row || row->needs.truth;
}

bool is_held_to_itself(const std::string& truth, const std::string& metric, const RunName& run, const Scene& scene) {
  const MetricRow* measured = find_metric(metric);
  if (measured && measured->needs.ensemble) return is_made_like_ensembles(run, scene);
  return is_against_truth(metric) && is_made_by(truth, run, scene);
}

bool is_case_held_to_itself(const Case& definition, const std::string& metric, const RunName& run) {
  const auto recording = definition.recording;
  if (recording && recording->synthetic == run.engine && is_against_truth(metric)) return true;
  return is_held_to_itself(definition.truth, metric, run, definition.scene);
}

}  // namespace rigor::inline metric
