// How long a structure built to stand (built_at_rest.h) stands: the first instant at which a body has moved by more
// than half the radius of the sphere round it; the end of the run if none ever has.
#include "cases/metrics/measures/built_at_rest.h"
#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/shape_gap.h"

namespace rigor {
namespace {

MetricResult measure(const JudgedRun& run) {
  const std::string why_not = why_not_built_at_rest(run);
  if (!why_not.empty()) return {{}, why_not};
  const auto& samples = run.trajectory.samples;
  const BodyColumns start = samples.front().bodies.columns();
  Measurement out;
  out.value = out.compared_until = samples.back().time;
  out.worst = {samples.back().time, kWorld, "displacement", 0, 0};
  for (const Sample& sample : samples) {
    for (std::size_t i = 0; i < start.size(); ++i) {
      if (run.scene.bodies[i].fixed) continue;
      const double moved = (sample.bodies.columns().position(i) - start.position(i)).norm();
      if (moved <= 0.5 * bounding_radius(*run.scene.bodies[i].shape)) continue;
      out.value = sample.time, out.worst = {sample.time, static_cast<int>(i), "displacement", moved, 0};
      return {out, ""};
    }
  }
  return {out, ""};
}

}  // namespace

MetricRow collapse_time() {
  return {"collapse_time", "s", "how long a structure built to stand stands; higher is better", measure, true};
}

}  // namespace rigor
