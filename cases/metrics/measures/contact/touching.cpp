#include "cases/metrics/measures/contact/touching.h"

#include <algorithm>
#include <limits>

namespace rigor::inline metric {

double smallest_half_width(const Scene& scene) {
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : scene.bodies)
    if (body.shape && !body.fixed) least = std::min(least, inradius(*body.shape));
  return least;
}

double touching_gap(const Scene& scene) {
  constexpr double kOfHalfWidth = 1e-7;
  return kOfHalfWidth * smallest_half_width(scene);
}

Vec3 velocity_at(BodyColumns bodies, int body, const Vec3& place) {
  const auto i = static_cast<std::size_t>(body);
  return bodies.velocity(i) + bodies.angular_velocity(i).cross(place - bodies.position(i));
}

}  // namespace rigor::inline metric
