#include "cases/metrics/measures/built_at_rest.h"

#include <algorithm>
#include <vector>

#include "cases/metrics/measures/shape_gap.h"
#include "core/dynamics/model/system.h"

namespace rigor::inline metric {

std::string why_not_built_at_rest(const JudgedRun& run) {
  const Scene& scene = run.scene;
  if (run.trajectory.samples.empty()) return "the run has no finite sample";
  if (!scene.springs.empty() || !scene.joints.empty()) return "more than gravity acts";
  const double end = run.trajectory.samples.back().time;
  const bool are_constant = std::all_of(scene.forces.begin(), scene.forces.end(),
                                        [&](const TimedForce& force) { return force.from == 0 && force.until >= end; });
  if (!are_constant || (!run.truth && !scene.forces.empty())) return "more than gravity acts";
  if (run.truth) {
    for (const KeptBodies& table : run.truth->bodies) {
      for (std::size_t i = 0; i < table.size(); ++i) {
        if (!table.columns().velocity(i).isZero(0)) return "bodies move in truth";
      }
    }
  }
  BodyTable start(scene.bodies.size());
  set_initial_state(scene, start.columns());
  std::vector<bool> touches(scene.bodies.size());
  constexpr double kTouch = 1e-3;  // m: a structure may be built with a little play
  for_each_near_pair(scene, start.columns(), kTouch, [&](int a, int b, double) { touches[a] = touches[b] = true; });
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed) continue;
    if (!body.velocity.isZero(0) || !body.angular_velocity.isZero(0)) return "bodies move at the start";
    if (!touches[i]) return "a body starts without touching another";
  }
  return "";
}

std::optional<Instant> collapse_of(const JudgedRun& run) {
  const BodyColumns start = run.trajectory.samples.front().bodies.columns();
  for (const Sample& sample : run.trajectory.samples) {
    for (std::size_t i = 0; i < start.size(); ++i) {
      if (run.scene.bodies[i].fixed) continue;
      const double moved = (sample.bodies.columns().position(i) - start.position(i)).norm();
      if (moved > 0.5 * bounding_radius(*run.scene.bodies[i].shape))
        return Instant{sample.time, static_cast<int>(i), "displacement", moved, 0};
    }
  }
  return {};
}

}  // namespace rigor::inline metric
