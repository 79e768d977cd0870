#include "core/dynamics/collision/conservative_advancement.h"

#include <algorithm>
#include <limits>

namespace rigor {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMissed = 1e-11;  // m: an overlap that is not looked for, a tenth of a gap that counts as closed

// The support of a shape along n after t, at most.
struct SupportBound {
  BodyColumns state;
  int body;
  Vec3 n;
  double acceleration;  // m/s², A
  double t;             // s, may be negative

  double point(const Vec3& arm) const {
    const Vec3 velocity = state.velocity(body) + state.angular_velocity(body).cross(arm);
    return n.dot(state.position(body) + arm + t * velocity) + 0.5 * acceleration * t * t;
  }
  double operator()(const Sphere& sphere) const { return point(Vec3::Zero()) + sphere.radius; }
  double operator()(const Capsule& capsule) const {
    const Vec3 arm = 0.5 * capsule.length * state.rotation(body).col(2);
    return std::max(point(arm), point(-arm)) + capsule.radius;
  }
  double operator()(const Box& box) const {
    const Mat3 R = state.rotation(body);
    double most = -kInfinity;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
      most = std::max(most, point(R * sign.cwiseProduct(box.size)));
    }
    return most;
  }
  // Only ever asked along its own normal.
  double operator()(const Plane& plane) const { return n.dot(plane.normal) * plane.offset; }
};

double acceleration_bound(const Collider& collider, BodyColumns from, BodyColumns to, double h) {
  if (collider.fixed) return 0;
  const int i = collider.body;
  const double linear = 2 * (to.velocity(i) - from.velocity(i)).norm() / h;
  if (std::holds_alternative<Sphere>(collider.shape)) return linear;
  const double w = std::max(from.angular_velocity(i).norm(), to.angular_velocity(i).norm());
  const double angular = 2 * (to.angular_velocity(i) - from.angular_velocity(i)).norm() / h;
  return linear + (w * w + angular) * collider.bounding_radius;
}

}  // namespace

bool stay_apart(const Collider& a, const Collider& b, const SeparatingAxis& from, const SeparatingAxis& to, double h) {
  const double acceleration_a = acceleration_bound(a, from.state, to.state, h),
               acceleration_b = acceleration_bound(b, from.state, to.state, h);
  const auto is_clear = [&](const SeparatingAxis& at, double t) {
    const double to_b = std::visit(SupportBound{at.state, a.body, -at.n, acceleration_a, t}, a.shape);
    const double to_a = std::visit(SupportBound{at.state, b.body, at.n, acceleration_b, t}, b.shape);
    return to_a + to_b <= kMissed;
  };
  return is_clear(from, 0.5 * h) && is_clear(to, -0.5 * h);
}

}  // namespace rigor
