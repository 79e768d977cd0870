// |speed of separation / speed of approach - e| of an impact, the largest over the run's impacts (impacts.h). Needs no
// truth.
#include <cmath>

#include "cases/metrics/measures/contact/impacts.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_restitution_error(const JudgedRun& run) {
  Measurement out;
  bool has_any = false;
  for (const auto& [pair, impacts] : impacts_of(run.scene, run.trajectory, run.leapfrog_stagger)) {
    const double expected = run.scene.contact_law(pair.first, pair.second).restitution;
    const int mover = run.scene.bodies[pair.first].fixed ? pair.second : pair.first;
    for (const ImpactSpeeds& impact : impacts) {
      const double found = impact.after / impact.before, error = std::abs(found - expected);
      if (has_any && error <= out.value) continue;
      has_any = true, out.value = error;
      out.worst = {impact.time, mover, "restitution", found, expected};
    }
  }
  if (!has_any) return {{}, kNoImpact};
  out.compared_until = run.trajectory.samples.back().time;
  return {out, ""};
}

}  // namespace

MetricRow restitution_error() {
  return {.name = "restitution_error",
          .unit = "1",
          .summary = "largest error of an impact's separation speed over its approach speed",
          .measure = measure_restitution_error,
          .needs = {}};
}

}  // namespace rigor::inline metric
