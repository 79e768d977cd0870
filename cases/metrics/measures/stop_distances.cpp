#include "cases/metrics/measures/stop_distances.h"

#include "cases/metrics/measures/measuring.h"
#include "core/scene/features/features.h"

namespace rigor::inline metric {

std::vector<Stop> stops_of(const JudgedRun& run, std::string& why_none) {
  if (!needs(run.scene, Feature::friction_coulomb))
    return why_none = "no finite friction brings a body to a stop", std::vector<Stop>{};
  if (!run.truth) return why_none = kNoTruth, std::vector<Stop>{};
  const std::size_t count = samples_within(run, kTruthNeededPosition);
  if (count == 0) return why_none = kNoSamples, std::vector<Stop>{};
  const Sample &first = run.trajectory.samples.front(), &last = run.trajectory.samples[count - 1];
  const BodyColumns truth_first = run.truth->bodies.front().columns(),
                    truth_last = run.truth->bodies[count - 1].columns();
  std::vector<Stop> stops;
  for (std::size_t i = 0; i < run.scene.bodies.size(); ++i) {
    if (run.scene.bodies[i].fixed || !truth_last.velocity(i).isZero(0)) continue;
    const double expected = (truth_last.position(i) - truth_first.position(i)).norm();
    if (expected <= run.truth->error[count - 1]) continue;  // as far as the truth can tell it never moved
    const double found = (last.bodies.columns().position(i) - first.bodies.columns().position(i)).norm();
    stops.push_back({static_cast<int>(i), found, expected, last.time});
  }
  if (stops.empty()) why_none = "no body comes to a stop in truth";
  return stops;
}

}  // namespace rigor::inline metric
