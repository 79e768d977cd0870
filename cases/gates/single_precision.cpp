// A step rounds each position and velocity by up to 2^-24 of its size, in either direction. n steps therefore add up to
// the square root of n roundings. A velocity's rounding acts for the rest of the run. (Higham, Accuracy and Stability
// of Numerical Algorithms, 2.8.) The truth's largest kinetic energy bounds the distance and speed of bodies. A step
// consists of several operations, each with a rounding.
#include "cases/gates/single_precision.h"

#include <algorithm>
#include <cmath>

#include "core/engine/simulation.h"

namespace rigor::inline gates {
namespace {

constexpr double kUnitRoundoff = 0x1p-24;
constexpr double kRoundingsAStep = 8;

// The largest value of each, over the moving bodies.
struct Sizes {
  double mass = 0, inertia = 0;           // kg, kg m²
  double place = 0, speed = 0, spin = 0;  // m, m/s, rad/s
  double energy = 0, kinetic = 0;         // J: at stake, and of the truth
};

Sizes sizes_of(const CaseResult& result) {
  const Scene& scene = result.definition.scene;
  const double time = result.definition.duration, kinetic = result.truth ? result.truth->largest_kinetic_energy : 0;
  Sizes sizes;
  sizes.kinetic = kinetic;
  for (const Body& body : scene.bodies) {
    if (body.fixed) continue;
    const double least = body.inertia.diagonal().minCoeff();
    const double speed = std::max(body.velocity.norm(), std::sqrt(2 * kinetic / body.mass));
    const double spin = std::max(body.angular_velocity.norm(), std::sqrt(2 * kinetic / least));
    const double fall = scene.gravity.norm() * time;
    sizes.mass += body.mass, sizes.inertia += body.inertia.diagonal().maxCoeff();
    sizes.speed = std::max(sizes.speed, kinetic > 0 ? speed : speed + fall);
    sizes.spin = std::max(sizes.spin, spin);
    sizes.place = std::max(sizes.place, body.position.norm());
  }
  sizes.place += sizes.speed * time;
  sizes.energy = kinetic + sizes.mass * scene.gravity.norm() * sizes.place;
  return sizes;
}

}  // namespace

double single_precision_allowance(const CaseResult& result, double dt, const std::string& unit) {
  const Sizes of = sizes_of(result);
  const double time = result.definition.duration, steps = static_cast<double>(steps_in(time, dt));
  const double relative = kRoundingsAStep * kUnitRoundoff * std::sqrt(std::max(1.0, steps));
  if (unit == "m") return relative * (of.place + of.speed * time);
  if (unit == "m/s") return relative * of.speed;
  if (unit == "rad") return relative * (1 + of.spin * time);
  if (unit == "rad/s") return relative * of.spin;
  if (unit == "kg m/s") return relative * of.mass * of.speed;
  if (unit == "kg m²/s") return relative * (of.inertia * of.spin + of.mass * of.speed * of.place);
  if (unit == "1") return relative * std::max(1.0, of.kinetic > 0 ? of.energy / of.kinetic : 1.0);
  return 0;
}

}  // namespace rigor::inline gates
