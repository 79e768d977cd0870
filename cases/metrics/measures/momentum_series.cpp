#include "cases/metrics/measures/momentum_series.h"

#include <fmt/format.h>

#include <algorithm>

#include "cases/metrics/measures/measuring.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

bool holds_still(const Scene& scene, int body) { return body == kWorld || scene.bodies[body].fixed; }

void compare(const Sample& sample, const std::string& symbol, const Vec3& found, const Vec3& expected,
             TimeSeries& series) {
  int axis = 0;
  (found - expected).cwiseAbs().maxCoeff(&axis);
  series.add((found - expected).norm(),
             {sample.time, kWorld, fmt::format("{}.{}", symbol, "xyz"[axis]), found[axis], expected[axis]});
}

}  // namespace

std::string why_held_from_outside(const Scene& scene) {
  const auto held = [&](const auto& link, const char* what) -> std::string {
    if (holds_still(scene, link.a) == holds_still(scene, link.b)) return "";
    return fmt::format("a {} holds '{}' to '{}'", what, scene.body_name(link.a), scene.body_name(link.b));
  };
  for (const Spring& spring : scene.springs) {
    if (const std::string why = held(spring, "spring"); !why.empty()) return why;
  }
  for (const Joint& joint : scene.joints) {
    if (const std::string why = held(joint, "joint"); !why.empty()) return why;
  }
  const ContactLaws laws(scene);
  const int count = static_cast<int>(scene.bodies.size());
  for (int i = 0; i < count; ++i) {
    if (!scene.bodies[i].collides || scene.bodies[i].fixed) continue;
    for (int k = 0; k < count; ++k) {
      if (scene.bodies[k].collides && scene.bodies[k].fixed && laws.may_touch(i, k))
        return fmt::format("'{}' may touch '{}', which is fixed", scene.bodies[i].name, scene.bodies[k].name);
    }
  }
  return "";
}

double acting_time(const TimedForce& force, double t) {
  return std::max(0.0, std::min(force.until, t) - std::max(force.from, 0.0));
}

MetricResult against_law(const JudgedRun& run, const std::string& symbol, const MomentumOf& momentum,
                         const MomentumGained& gained) {
  if (run.trajectory.samples.empty()) return {{}, "the run has no finite sample"};
  const Vec3 start = momentum(run.trajectory.samples.front().bodies.columns());
  TimeSeries series;
  for (const Sample& sample : run.trajectory.samples) {
    compare(sample, symbol, momentum(sample.bodies.columns()), start + gained(sample.time), series);
  }
  return {std::move(series).finish(), ""};
}

MetricResult against_truth(const JudgedRun& run, const std::string& symbol, const MomentumOf& momentum,
                           const std::string& why) {
  if (!run.truth) return {{}, fmt::format("{}, and the case has no truth", why)};
  const std::size_t count = samples_within(run, kTruthNeededPosition);
  if (count == 0) return {{}, kNoSamples};
  TimeSeries series;
  for (std::size_t n = 0; n < count; ++n) {
    const Sample& sample = run.trajectory.samples[n];
    compare(sample, symbol, momentum(sample.bodies.columns()), momentum(run.truth->bodies[n].columns()), series);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace rigor::inline metric
