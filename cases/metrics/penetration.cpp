// The deepest overlap of two bodies' shapes at any sample, by the judge's own geometry (shape_gap.h); zero where all
// keep apart. What the scene overlaps at the start is not the engine's doing and is taken off.
#include <fmt/format.h>

#include <map>

#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/shape_gap.h"
#include "core/scene/contact_laws.h"

namespace rigor {
namespace {

using Pair = std::pair<int, int>;

std::map<Pair, double> overlaps_of(const Scene& scene) {
  BodyTable start(scene.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    start.columns().set_position(i, scene.bodies[i].position);
    start.columns().set_orientation(i, scene.bodies[i].orientation);
  }
  std::map<Pair, double> overlaps;
  for_each_near_pair(scene, start.columns(), 0, [&](int a, int b, double gap) { overlaps[{a, b}] = -gap; });
  return overlaps;
}

MetricResult measure(const JudgedRun& run) {
  if (!anything_can_touch(run.scene)) return {{}, "no two bodies of the scene can touch"};
  if (run.trajectory.samples.empty()) return {{}, "the run has no finite sample"};
  const std::map<Pair, double> at_start = overlaps_of(run.scene);
  TimeSeries series;
  for (const Sample& sample : run.trajectory.samples) {
    double deepest = 0;
    Instant worst{sample.time, kWorld, "gap", 0, 0};
    for_each_near_pair(run.scene, sample.bodies.columns(), 0, [&](int a, int b, double gap) {
      const auto known = at_start.find({a, b});
      const double depth = -gap - (known == at_start.end() ? 0 : known->second);
      if (depth <= deepest) return;
      deepest = depth;
      const int mover = run.scene.bodies[a].fixed ? b : a, other = mover == a ? b : a;
      worst = {sample.time, mover, fmt::format("gap to '{}'", run.scene.bodies[other].name), gap, 0};
    });
    series.add(deepest, worst);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow penetration() {
  return {"penetration", "m", "deepest overlap of two bodies' shapes, beyond what the scene starts with", measure};
}

}  // namespace rigor
