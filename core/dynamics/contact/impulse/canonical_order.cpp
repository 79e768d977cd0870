#include "core/dynamics/contact/impulse/canonical_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace rigor::inline dynamics {
namespace {

constexpr std::size_t kMostOrdered = 100;  // colliders
// Lengths and masses that differ by less count as equal: rounding must not decide.
constexpr double kEqual = 1e-6;

// In steps of kEqual. No round number lies on the border between two steps.
double in_steps(double x, double scale) { return scale > 0 ? std::floor(x / (kEqual * scale) + 0.37) : 0; }

// m/s
double speed_of(const Body& body, double size) { return body.velocity.norm() + size * body.angular_velocity.norm(); }

double fastest_of(const Scene& scene, double size) {
  double fastest = 0;
  for (const Body& body : scene.bodies) fastest = std::max(fastest, speed_of(body, size));
  return fastest;
}

Vec3 middle_of(const Scene& scene, const std::vector<Collider>& colliders) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (const Collider& collider : colliders) {
    if (!std::isfinite(collider.inradius)) continue;
    sum += scene.bodies[static_cast<std::size_t>(collider.body)].position, ++count;
  }
  return count > 0 ? Vec3(sum / count) : sum;
}

std::array<double, 5> rank_of(const Scene& scene, const Collider& collider, double size) {
  if (const auto* plane = std::get_if<Plane>(&collider.shape)) return {1, in_steps(plane->offset, size)};
  const Body& body = scene.bodies[static_cast<std::size_t>(collider.body)];
  const double height = scene.gravity.isZero(0) ? 0 : -scene.gravity.normalized().dot(body.position);
  return {0, in_steps(height, size), body.fixed ? 0 : in_steps(std::log(body.mass), 1),
          in_steps(collider.bounding_radius, size), in_steps(speed_of(body, size), fastest_of(scene, size))};
}

// The first of these vectors that is not across the axis says which way along it counts as forwards.
double sign_along(const Vec3& axis, const std::array<Vec3, 4>& vectors) {
  for (const Vec3& v : vectors) {
    const double along = axis.dot(v);
    if (std::abs(along) > kEqual * v.norm()) return along > 0 ? 1 : -1;
  }
  return 1;
}

}  // namespace

std::vector<Collider> in_canonical_order(const Scene& scene, std::vector<Collider> colliders) {
  if (colliders.size() > kMostOrdered) return colliders;
  double size = 0;
  for (const Collider& collider : colliders) {
    if (std::isfinite(collider.bounding_radius)) size = std::max(size, collider.bounding_radius);
  }
  std::vector<std::array<double, 5>> ranks;
  for (const Collider& collider : colliders) ranks.push_back(rank_of(scene, collider, size));
  std::vector<std::size_t> order(colliders.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return ranks[x] < ranks[y]; });
  std::vector<Collider> ordered;
  for (const std::size_t i : order) ordered.push_back(colliders[i]);
  return ordered;
}

std::vector<Vec3> mirrored_axes(const Scene& scene, const std::vector<Collider>& colliders) {
  const Vec3 middle = middle_of(scene, colliders);
  std::vector<Vec3> axes;
  for (const Collider& collider : colliders) {
    axes.push_back(Vec3::Ones());
    if (!std::holds_alternative<Box>(collider.shape)) continue;
    const Body& body = scene.bodies[static_cast<std::size_t>(collider.body)];
    const Mat3 R = matrix_of(body.orientation);
    const Vec3 &g = scene.gravity, &v = body.velocity, &w = body.angular_velocity, place = body.position - middle;
    for (int k = 0; k < 3; ++k) axes.back()[k] = sign_along(R.col(k), {-g, v, w.cross(g), place});
  }
  return axes;
}

}  // namespace rigor::inline dynamics
