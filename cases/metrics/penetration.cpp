// The deepest overlap of two bodies' shapes at any sample (overlaps.h); zero if all stay apart. Overlap of the scene's
// start is subtracted, because the engine did not cause it.
#include <fmt/format.h>

#include "cases/metrics/measures/contact/overlaps.h"
#include "cases/metrics/measures/measuring.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_penetration(const JudgedRun& run) {
  if (!anything_can_touch(run.scene)) return {{}, "no two bodies of the scene can touch"};
  if (run.trajectory.samples.empty()) return {{}, "the run has no finite sample"};
  const Overlaps overlaps(run.scene);
  TimeSeries series;
  for (const Sample& sample : run.trajectory.samples) {
    double deepest = 0;
    Instant worst{sample.time, kWorld, "gap", 0, 0};
    overlaps.visit(sample.bodies.columns(), [&](const Overlap& found) {
      if (found.depth <= deepest) return;
      deepest = found.depth;
      const int mover = run.scene.bodies[found.a].fixed ? found.b : found.a,
                other = mover == found.a ? found.b : found.a;
      worst = {sample.time, mover, fmt::format("gap to '{}'", run.scene.bodies[other].name), found.gap, 0};
    });
    series.add(deepest, worst);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow penetration() {
  return {.name = "penetration",
          .unit = "m",
          .summary = "deepest overlap of two bodies' shapes, beyond what the scene starts with",
          .measure = measure_penetration,
          .needs = {}};
}

}  // namespace rigor::inline metric
