#include "core/dynamics/contact/impulse/scene_scales.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rigor {
namespace {

// A speed counts as the acceleration v²/L times this. Gravity alone decides in scenes that fall from usual heights.
constexpr double kShareOfSpeed = 0.01;

struct Volume {
  double operator()(const Sphere& s) const { return 4 * std::numbers::pi / 3 * s.radius * s.radius * s.radius; }
  double operator()(const Box& b) const { return b.size.prod(); }
  double operator()(const Capsule& c) const {
    return (4.0 / 3 * c.radius + c.length) * std::numbers::pi * c.radius * c.radius;
  }
  double operator()(const Plane&) const { return 0; }
};

// m/s²; a moment counts by the torque's acceleration of a point at the distance `length`.
double largest_load(const Scene& scene, double length) {
  double most = 0;
  const auto add = [&](int body, double force) {
    if (body != kWorld && !scene.bodies[static_cast<std::size_t>(body)].fixed)
      most = std::max(most, force / scene.bodies[static_cast<std::size_t>(body)].mass);
  };
  for (const TimedForce& force : scene.forces) add(force.body, force.force.norm() + force.torque.norm() / length);
  for (const Spring& spring : scene.springs) {
    for (const int body : {spring.a, spring.b}) add(body, spring.stiffness * length);
  }
  return most;
}

}  // namespace

SceneScales scales_of(const Scene& scene) {
  double sum = 0, fastest = 0;
  int count = 0;
  for (const Body& body : scene.bodies) {
    if (body.fixed || !body.collides) continue;
    sum += 0.5 * std::cbrt(std::visit(Volume(), *body.shape)), ++count;
  }
  const double length = count > 0 ? sum / count : 1;
  for (const Body& body : scene.bodies) {
    if (!body.fixed) fastest = std::max(fastest, body.velocity.norm() + length * body.angular_velocity.norm());
  }
  double acceleration = std::max(scene.gravity.norm(), kShareOfSpeed * fastest * fastest / length);
  if (acceleration == 0) acceleration = largest_load(scene, length);
  return {length, std::sqrt(length / acceleration)};
}

}  // namespace rigor
