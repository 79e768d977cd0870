#include "cases/metrics/measures/energy_in_play.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cases/metrics/measures/momentum_series.h"
#include "cases/metrics/measures/shape_gap.h"
#include "core/dynamics/model/energy.h"
#include "core/dynamics/model/system.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

// m/s: gained by a body of that speed that falls by `height`.
double gained_falling(double speed, double gravity, double height) {
  return std::sqrt(speed * speed + 2 * gravity * std::max(0.0, height)) - speed;
}

double inradius_of(const Body& body) { return body.shape ? inradius(*body.shape) : 0; }

// m/s: falling on the plane, then sliding down it. A plane that does not face up holds nothing.
double gained_over(const Plane& plane, const Body& body, const Vec3& gravity, double duration) {
  const double rise = -gravity.normalized().dot(plane.normal);  // the cosine of its slope
  if (rise <= 1e-9) return std::numeric_limits<double>::infinity();
  const double gap = plane.normal.dot(body.position) - plane.offset - inradius_of(body);
  const double slope = std::sqrt(std::max(0.0, 1 - rise * rise));  // its sine
  constexpr double kLevel = 1e-6;                                  // of a normal's roundings
  return gained_falling(body.velocity.norm(), gravity.norm(), gap / rise) +
         (slope > kLevel ? gravity.norm() * slope * duration : 0);
}

double height_of(const Scene& scene, const Vec3& point) { return -scene.gravity.normalized().dot(point); }  // m

// m: the lowest that each body's centre can hang by the scene's springs; minus infinity if nothing fixed holds it. A
// body is let down by each spring from the lowest place of the spring's other end.
std::vector<double> lowest_hanging(const Scene& scene) {
  std::vector<double> lowest(scene.bodies.size(), -std::numeric_limits<double>::infinity());
  double weight = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed) lowest[i] = height_of(scene, body.position);
    if (!body.fixed) weight += body.mass * scene.gravity.norm();
  }
  const auto end = [&](int body, const Vec3& point) {
    return body == kWorld ? point : Vec3(scene.bodies[body].position + scene.bodies[body].orientation * point);
  };
  const auto let_down = [&](int body, const Vec3& point, int from, const Vec3& point_from, const Spring& spring) {
    if (body == kWorld || scene.bodies[body].fixed) return false;
    const double top = from == kWorld ? height_of(scene, point_from) : lowest[from] - point_from.norm();
    const double length = (end(spring.a, spring.point_a) - end(spring.b, spring.point_b)).norm();
    const double low = top - std::max(length, spring.rest_length) - 2 * weight / spring.stiffness - point.norm();
    if (!(low > lowest[body])) return false;
    lowest[body] = low;
    return true;
  };
  for (bool changes = true; changes;) {  // each pass reaches one spring further; a rise never goes round
    changes = false;
    for (const Spring& s : scene.springs) {
      changes |= let_down(s.a, s.point_a, s.b, s.point_b, s);
      changes |= let_down(s.b, s.point_b, s.a, s.point_a, s);
    }
  }
  return lowest;
}

// m/s: the most that gravity can add to the speed of a body that falls no lower than `hanging`.
double gained_by_gravity(const Scene& scene, int index, const ContactLaws& laws, double hanging, double duration) {
  const Body& body = scene.bodies[index];
  const double g = scene.gravity.norm();
  if (g == 0) return 0;
  const double free =
      std::min(g * duration, gained_falling(body.velocity.norm(), g, height_of(scene, body.position) - hanging));
  if (!body.collides) return free;
  double least = free, lowest = std::numeric_limits<double>::infinity();
  bool has_plane = false;
  for (const Body& support : scene.bodies) {
    const int other = static_cast<int>(&support - scene.bodies.data());
    if (!support.collides || !support.fixed || !laws.may_touch(index, other)) continue;
    if (const auto* plane = std::get_if<Plane>(&*support.shape)) {
      has_plane = true;
      least = std::min(least, gained_over(*plane, body, scene.gravity, duration));
    } else {
      lowest = std::min(lowest, height_of(scene, support.position) - bounding_radius(*support.shape));
    }
  }
  if (has_plane || !std::isfinite(lowest)) return least;
  return std::min(free, gained_falling(body.velocity.norm(), g, height_of(scene, body.position) - lowest));
}

double stored_in_springs(const Scene& scene, BodyColumns bodies) {
  Scene springs_alone = scene;
  springs_alone.gravity.setZero();
  return potential_energy(springs_alone, bodies);
}

double to_lift_everything(const Scene& scene) {
  double sum = 0;
  for (const Body& body : scene.bodies) {
    if (!body.fixed) sum += body.mass * scene.gravity.norm() * inradius_of(body);
  }
  return sum;
}

}  // namespace

double energy_in_play(const Scene& scene, double duration) {
  BodyTable start(scene.bodies.size());
  set_initial_state(scene, start.columns());
  double sum = stored_in_springs(scene, start.columns());
  const std::vector<double> hanging = lowest_hanging(scene);
  const ContactLaws laws(scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed) continue;
    double gained = gained_by_gravity(scene, static_cast<int>(i), laws, hanging[i], duration);
    for (const TimedForce& force : scene.forces) {
      if (force.body == static_cast<int>(i)) gained += acting_time(force, duration) * force.force.norm() / body.mass;
    }
    const double speed = body.velocity.norm();
    sum += kinetic_energy_of(scene, start.columns(), i) + 0.5 * body.mass * gained * (2 * speed + gained);
  }
  if (sum <= 0) sum = to_lift_everything(scene);
  return sum > 0 ? sum : 1;
}

}  // namespace rigor::inline metric
