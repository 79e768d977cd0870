// P = sum m v must be P(0) + M g t + the impulses of the timed forces, if nothing holds the bodies from outside.
// Otherwise it is compared with the truth's. Absolute, so that it has the same meaning if P(0) = 0.
#include "cases/metrics/measures/momentum_series.h"
#include "core/dynamics/model/energy.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_linear_momentum_drift(const JudgedRun& run) {
  const Scene& scene = run.scene;
  const MomentumOf momentum = [&](BodyColumns bodies) { return linear_momentum(scene, bodies); };
  if (const std::string why = why_held_from_outside(scene); !why.empty()) return against_truth(run, "P", momentum, why);

  double moving_mass = 0;
  for (const Body& body : scene.bodies) moving_mass += body.fixed ? 0 : body.mass;
  return against_law(run, "P", momentum, [&](double t) {
    Vec3 gained = t * moving_mass * scene.gravity;
    for (const TimedForce& force : scene.forces) {
      if (!scene.bodies[force.body].fixed) gained += acting_time(force, t) * force.force;
    }
    return gained;
  });
}

}  // namespace

MetricRow linear_momentum_drift() {
  return {"linear_momentum_drift", "kg m/s", "largest deviation of the system's linear momentum from what it must be",
          measure_linear_momentum_drift};
}

}  // namespace rigor::inline metric
