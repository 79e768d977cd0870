// The largest difference in time between the k-th impact of a pair in the run and in truth (impacts.h, both from
// samples at the same instants). A missing impact is late by the rest of the run.
#include <cmath>

#include "cases/metrics/measures/contact/impacts.h"
#include "cases/metrics/measures/measuring.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

Trajectory truth_of(const JudgedRun& run, std::size_t count) {
  Trajectory truth{run.trajectory.dt, {}};
  for (std::size_t n = 0; n < count; ++n)
    truth.samples.push_back({run.trajectory.samples[n].time, run.truth->bodies[n]});
  return truth;
}

MetricResult measure_impact_time_error(const JudgedRun& run) {
  if (!run.truth) return {{}, kNoTruth};
  const std::size_t count = samples_within(run, kTruthNeededPosition);
  if (count == 0) return {{}, kNoSamples};
  if (!anything_can_touch(run.scene)) return {{}, kNoImpact};
  const Trajectory truth = truth_of(run, count);
  const auto expected = impacts_of(run.scene, truth, 0);
  if (expected.empty()) return {{}, kNoImpact};
  const auto found = impacts_of(run.scene, run.trajectory, run.leapfrog_stagger);
  const double end = truth.samples.back().time;
  Measurement out;
  for (const auto& [pair, impacts] : expected) {
    const int mover = run.scene.bodies[pair.first].fixed ? pair.second : pair.first;
    const auto known = found.find(pair);
    const std::size_t in_run = known == found.end() ? 0 : known->second.size();
    // The last ones may be missing for being slower than a tenth of the fastest by a hair.
    for (std::size_t k = 0; k < impacts.size() && (k < in_run || k == 0); ++k) {
      const double time = k < in_run ? known->second[k].time : end, error = std::abs(time - impacts[k].time);
      if (error >= out.value) out.value = error, out.worst = {impacts[k].time, mover, "impact", time, impacts[k].time};
    }
  }
  out.compared_until = end;
  return {out, ""};
}

}  // namespace

MetricRow impact_time_error() {
  return {"impact_time_error", "s", "largest distance in time of an impact from the true one",
          measure_impact_time_error};
}

}  // namespace rigor::inline metric
