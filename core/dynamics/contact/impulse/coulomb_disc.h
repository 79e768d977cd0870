// Coulomb's law for the impulse across a contact's normal: onto the disc of radius mu p_n.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace rigor::inline dynamics {

using Vec2 = Eigen::Vector2d;  // along the two tangents of a contact

// kg: the inverse of the tangents' inverse effective mass K = [tt ts; ts ss], and 1 / its larger eigenvalue.
struct TangentMass {
  double tt = 0, ss = 0, ts = 0, slip = 0;

  Vec2 times(const Vec2& u) const { return {tt * u.x() + ts * u.y(), ts * u.x() + ss * u.y()}; }
};

inline TangentMass tangent_mass_of(double tt, double ss, double ts) {
  const double over = 1 / (tt * ss - ts * ts), apart = 0.5 * (tt - ss);
  return {ss * over, tt * over, -ts * over, 1 / (0.5 * (tt + ss) + std::hypot(apart, ts))};
}

// The next impulse, from the last one and its remaining slip: the sticking one if it is within the disc, else one
// against the slip. The latter converges only with one mass for all directions.
inline Vec2 onto_disc(const Vec2& impulse, const Vec2& slip, const TangentMass& mass, double radius) {
  const Vec2 stick = impulse - mass.times(slip);
  if (stick.norm() <= radius) return stick;
  const Vec2 slide = impulse - mass.slip * slip;
  const double size = slide.norm();
  return size > radius ? Vec2(radius / size * slide) : slide;
}

}  // namespace rigor::inline dynamics
