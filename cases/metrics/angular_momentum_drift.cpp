// The drift of the angular momentum about the moving bodies' centre of mass, which neither gravity nor springs between
// them change. It must be L(0) plus the impulses of timed torques, if nothing holds the bodies from outside and no
// timed force has an arm that depends on the motion. Otherwise it is compared with the truth's. Absolute, because L(0)
// may be 0.
#include <fmt/format.h>

#include <algorithm>

#include "cases/metrics/measures/momentum_series.h"
#include "core/dynamics/model/energy.h"

namespace rigor::inline metric {
namespace {

Vec3 centre_of_mass(const Scene& scene, BodyColumns bodies) {
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (scene.bodies[i].fixed) continue;
    sum += scene.bodies[i].mass * bodies.position(i);
    mass += scene.bodies[i].mass;
  }
  return mass > 0 ? Vec3(sum / mass) : sum;
}

// A force at the centre of the only moving body has no arm.
std::string why_arms_are_unknown(const Scene& scene) {
  const auto moving = std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return !b.fixed; });
  for (const TimedForce& force : scene.forces) {
    if (force.force.isZero(0) || scene.bodies[force.body].fixed) continue;
    if (moving > 1 || !force.point.isZero(0)) {
      return fmt::format("the force on '{}' has an arm about the centre of mass", scene.body_name(force.body));
    }
  }
  return "";
}

MetricResult measure_angular_momentum_drift(const JudgedRun& run) {
  const Scene& scene = run.scene;
  const MomentumOf momentum = [&](BodyColumns bodies) {
    return angular_momentum(scene, bodies, centre_of_mass(scene, bodies));
  };
  for (const std::string& why : {why_held_from_outside(scene), why_arms_are_unknown(scene)}) {
    if (!why.empty()) return against_truth(run, "L", momentum, why);
  }
  return against_law(run, "L", momentum, [&](double t) {
    Vec3 gained = Vec3::Zero();
    for (const TimedForce& force : scene.forces) {
      if (!scene.bodies[force.body].fixed) gained += acting_time(force, t) * force.torque;
    }
    return gained;
  });
}

}  // namespace

MetricRow angular_momentum_drift() {
  return {"angular_momentum_drift", "kg m²/s",
          "largest deviation of the angular momentum about the centre of mass from what it must be",
          measure_angular_momentum_drift};
}

}  // namespace rigor::inline metric
