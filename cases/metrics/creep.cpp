// How far a body that should stay where it is has moved from its start, in a scene built to stand (built_at_rest.h). It
// counts the settling of the first steps too.
#include "cases/metrics/measures/built_at_rest.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_creep(const JudgedRun& run) {
  const std::string why_not = why_not_built_at_rest(run);
  if (!why_not.empty()) return {{}, why_not};
  const BodyColumns start = run.trajectory.samples.front().bodies.columns();
  TimeSeries series;
  for (const Sample& sample : run.trajectory.samples) {
    double farthest = 0;
    Instant worst{sample.time, kWorld, "displacement", 0, 0};
    for (std::size_t i = 0; i < start.size(); ++i) {
      const double moved = (sample.bodies.columns().position(i) - start.position(i)).norm();
      if (moved <= farthest) continue;
      farthest = moved;
      worst = {sample.time, static_cast<int>(i), "displacement", moved, 0};
    }
    series.add(farthest, worst);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow creep() {
  return {.name = "creep",
          .unit = "m",
          .summary = "how far a body built to stand still has moved from its start",
          .measure = measure_creep,
          .needs = {}};
}

}  // namespace rigor::inline metric
