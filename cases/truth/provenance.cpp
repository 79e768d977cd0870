#include "cases/truth/provenance.h"

#include <algorithm>
#include <vector>

#include "cases/metrics/metric.h"
#include "core/dynamics/contact/contact_method.h"
#include "core/world.h"

namespace rigor {

// One declaration and one row a truth that is solved; each is defined in the file of its name.
Provenance events_provenance();
Provenance reference_provenance();

namespace {

const Provenance* row_of(const std::string& truth) {
  static const std::vector<Provenance> table = {events_provenance(), reference_provenance()};
  const auto row = std::find_if(table.begin(), table.end(), [&](const Provenance& one) { return one.truth == truth; });
  return row == table.end() ? nullptr : &*row;
}

// The reference of ensembles is the core, with the contact that it gives a scene by itself (runner/ensemble.h).
bool is_made_like_ensembles(const RunName& run, const Scene& scene) {
  const auto& options = run.settings.options;
  return run.engine == core_info().name &&
         (!options.contains("contact") || options.at("contact") == contact_method_for(scene).name);
}

}  // namespace

std::string provenance_of(const std::string& truth) {
  if (truth == "none") return "";
  const Provenance* row = row_of(truth);
  return row ? row->how : "a closed form, independent of every engine and method";
}

bool is_against_truth(const std::string& metric) {
  if (metric == "spread" || metric == "spread_orientation") return false;  // runs are compared with each other
  const MetricRow* row = find_metric(metric);
  return !row || row->needs.truth;
}

bool is_held_to_itself(const std::string& truth, const std::string& metric, const RunName& run, const Scene& scene) {
  const MetricRow* measured = find_metric(metric);
  if (measured && measured->needs.ensemble) return is_made_like_ensembles(run, scene);
  const Provenance* row = row_of(truth);
  return row && row->is_made_like && is_against_truth(metric) && row->is_made_like(run, scene);
}

}  // namespace rigor
