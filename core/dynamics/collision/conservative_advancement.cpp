#include "core/dynamics/collision/conservative_advancement.h"

#include <algorithm>
#include <limits>

namespace rigor::inline dynamics {
namespace {

// Calls add(centre, radius) for balls whose hull encloses the shape, as far as it reaches along n.
template <typename Add>
struct BallsAround {
  const Add& add;
  Vec3 n;  // in the shape's frame, of any length

  void operator()(const Box& box) const {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
      add(sign.cwiseProduct(box.size), 0);
    }
  }
  void operator()(const Capsule& capsule) const { add_ends(capsule.length, capsule.radius); }
  void operator()(const Compound& compound) const { add(Vec3::Zero(), compound.bounding_radius()); }
  void operator()(const Convex& convex) const {
    for (const Vec3& corner : convex.hull->points) add(corner, 0);
  }
  void operator()(const Plane& plane) const { add(Vec3::Zero(), plane.bounding_radius()); }
  void operator()(const Sphere& sphere) const { add(Vec3::Zero(), sphere.radius); }
  void operator()(const SurfaceShape& on) const {
    for (const Vec3& corner : on.surface->points) add(corner, 0);
  }
  template <typename Solid>
  requires(!kStandsStill<Solid>) void operator()(const Solid& solid) const { add(solid.support(n), 0); }

 private:
  void add_ends(double length, double radius) const {
    for (const double end : {-0.5, 0.5}) add(end * length * Vec3::UnitZ(), radius);
  }
};

// The support of a shape along n after t, at most.
struct SupportBound {
  BodyColumns state;
  int body;
  Vec3 n;
  Bend bend;
  double bounding_radius;  // m, round the centre
  double t;                // s, may be negative

  double centre() const {
    return n.dot(state.position(body) + t * state.velocity(body)) + 0.5 * bend.of_centre * t * t;
  }
  double point(const Vec3& arm) const {
    const Vec3 velocity = state.velocity(body) + state.angular_velocity(body).cross(arm);
    return n.dot(state.position(body) + arm + t * velocity) + 0.5 * bend.of_points * t * t;
  }
  double operator()(const Sphere& sphere) const { return centre() + sphere.radius; }
  // A shape that is the hull of balls about points of the body.
  template <typename Other>
  double operator()(const Other& shape) const {
    const Mat3 R = state.rotation(body);
    double most = -std::numeric_limits<double>::infinity();
    // Along this, the point that moves furthest is the one that reaches furthest: n·(w x r) = (n x w)·r.
    const Vec3 furthest = R.transpose() * (n + t * n.cross(state.angular_velocity(body)));
    for_each_part(shape, [&](const Shape& part, const BodyPose& pose) {
      const auto add = [&](const Vec3& at, double radius) {
        most = std::max(most, point(R * (pose.position + pose.orientation * at)) + radius);
      };
      std::visit(BallsAround<decltype(add)>{add, pose.orientation.conjugate() * furthest}, part);
    });
    return std::min(most, centre() + bounding_radius);
  }
  double operator()(const Capsule& capsule) const {
    const Vec3 arm = 0.5 * capsule.length * state.rotation(body).col(2);
    return std::min(std::max(point(arm), point(-arm)) + capsule.radius, centre() + bounding_radius);
  }
  double operator()(const Box& box) const {
    const Mat3 R = state.rotation(body);
    double most = -std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
      most = std::max(most, point(R * sign.cwiseProduct(box.size)));
    }
    return std::min(most, centre() + bounding_radius);
  }
  // Only ever asked along its own normal.
  double operator()(const Plane& plane) const { return n.dot(plane.normal) * plane.offset; }
};

}  // namespace

double reach_at_most(const Collider& collider, BodyColumns state, const Vec3& n, const Bend& bend, double t) {
  return std::visit(SupportBound{state, collider.body, n, bend, collider.bounding_radius, t}, collider.shape);
}

bool stay_apart(const Collider& a, const Collider& b, const SeparatingAxis& from, const SeparatingAxis& to,
                const Bend& bend_a, const Bend& bend_b, double h, double missed) {
  const auto is_clear = [&](const SeparatingAxis& at, double t) {
    return reach_at_most(a, at.state, -at.n, bend_a, t) + reach_at_most(b, at.state, at.n, bend_b, t) <= missed;
  };
  return is_clear(from, 0.5 * h) && is_clear(to, -0.5 * h);
}

}  // namespace rigor::inline dynamics
