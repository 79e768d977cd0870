#include "cases/metrics/measures/energy_in_play.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/metrics/measures/momentum_series.h"
#include "cases/metrics/measures/shape_gap.h"
#include "core/dynamics/model/energy.h"
#include "core/dynamics/model/system.h"

namespace rigor {
namespace {

// m/s: gained by a body of that speed that falls by `height`.
double gained_falling(double speed, double gravity, double height) {
  return std::sqrt(speed * speed + 2 * gravity * std::max(0.0, height)) - speed;
}

double half_thickness(const Body& body) { return body.shape ? inradius(*body.shape) : 0; }

// m/s: falling on the plane, then sliding down it. A plane that does not face up holds nothing.
double gained_over(const Plane& plane, const Body& body, const Vec3& gravity, double duration) {
  const double rise = -gravity.normalized().dot(plane.normal);  // the cosine of its slope
  if (rise <= 1e-9) return std::numeric_limits<double>::infinity();
  const double gap = plane.normal.dot(body.position) - plane.offset - half_thickness(body);
  const double slope = std::sqrt(std::max(0.0, 1 - rise * rise));  // its sine
  constexpr double kLevel = 1e-6;                                  // of a normal's roundings
  return gained_falling(body.velocity.norm(), gravity.norm(), gap / rise) +
         (slope > kLevel ? gravity.norm() * slope * duration : 0);
}

// m/s: the most that gravity can add to a body's speed.
double gained_by_gravity(const Scene& scene, const Body& body, double duration) {
  const double g = scene.gravity.norm(), free = g * duration;
  if (g == 0 || !body.collides) return free;
  double least = free, lowest = std::numeric_limits<double>::infinity();
  bool has_plane = false;
  for (const Body& support : scene.bodies) {
    if (!support.collides || !support.fixed) continue;
    if (const auto* plane = std::get_if<Plane>(&*support.shape)) {
      has_plane = true;
      least = std::min(least, gained_over(*plane, body, scene.gravity, duration));
    } else {
      lowest = std::min(lowest, -scene.gravity.dot(support.position) / g - bounding_radius(*support.shape));
    }
  }
  if (has_plane || !std::isfinite(lowest)) return least;
  return std::min(free, gained_falling(body.velocity.norm(), g, -scene.gravity.dot(body.position) / g - lowest));
}

double stored_in_springs(const Scene& scene, BodyColumns bodies) {
  Scene springs_alone = scene;
  springs_alone.gravity.setZero();
  return potential_energy(springs_alone, bodies);
}

double to_lift_everything(const Scene& scene) {
  double sum = 0;
  for (const Body& body : scene.bodies) {
    if (!body.fixed) sum += body.mass * scene.gravity.norm() * half_thickness(body);
  }
  return sum;
}

}  // namespace

double energy_in_play(const Scene& scene, double duration) {
  BodyTable start(scene.bodies.size());
  set_initial_state(scene, start.columns());
  double sum = stored_in_springs(scene, start.columns());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed) continue;
    double gained = gained_by_gravity(scene, body, duration);
    for (const TimedForce& force : scene.forces) {
      if (force.body == static_cast<int>(i)) gained += acting_time(force, duration) * force.force.norm() / body.mass;
    }
    const double speed = body.velocity.norm();
    sum += kinetic_energy_of(scene, start.columns(), i) + 0.5 * body.mass * gained * (2 * speed + gained);
  }
  if (sum <= 0) sum = to_lift_everything(scene);
  return sum > 0 ? sum : 1;
}

}  // namespace rigor
