#include "core/dynamics/contact/event/features/feature_ends.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/dynamics/contact/event/features/round_surface.h"
#include "core/dynamics/contact/event/features/surface_features.h"

namespace rigor::inline dynamics {
namespace {

using Kind = ContactFeature::Kind;

constexpr double kEndless = std::numeric_limits<double>::infinity();

// m, from the ends of a shape's own feature, with `q` the point in B at which the other feature touches it: the centre
// of its ball, the foot on its axis, or its surface.
struct EndsOf {
  const ContactFeature &own, &other;
  Vec3 q;
  double reach;  // m: how far from an end it matters

  // A shape that is smooth, or of which only points are known; a compound's contact lasts to the end of its step.
  template <typename Other>
  requires(!std::is_base_of_v<SurfaceShape, Other>) double operator()(const Other&) const { return kEndless; }

  double operator()(const Capsule& capsule) const {
    const double half = 0.5 * capsule.length;
    if (own.kind == Kind::line) return half - std::abs(q.z());
    return own.is_vertex && other.kind != Kind::plane ? std::copysign(q.z(), q.z() * own.at.z()) - half : kEndless;
  }

  double operator()(const Box& box) const {
    const Vec3 half = 0.5 * box.size;
    const bool is_side = own.kind == Kind::plane, is_beside_round = other.radius > 0;
    if (is_side && (!other.is_vertex || own.direction.cwiseAbs().maxCoeff() < 1)) return kEndless;
    double least = kEndless;
    for (int i = 0; i < 3; ++i) {
      const double within = half[i] - std::abs(q[i]);
      const bool is_along = is_side ? own.direction[i] == 0 : own.kind == Kind::line && own.direction[i] != 0;
      if (is_along) least = std::min(least, within);
      // Beside an edge or a corner the ball's centre lies outside of two or three sides.
      if (!is_along && !is_side && is_beside_round)
        least = std::min(least, own.at[i] < 0 ? -q[i] - half[i] : q[i] - half[i]);
    }
    return own.kind == Kind::point && !own.is_vertex ? kEndless : least;
  }

  double operator()(const Convex& convex) const {
    const Hull& hull = *convex.hull;
    double least = kEndless;
    for (const Hull::Edge& edge : hull.edges) {
      const Vec3 &from = hull.points[static_cast<std::size_t>(edge.from)],
                 &to = hull.points[static_cast<std::size_t>(edge.to)], along = (to - from).normalized();
      if (own.kind == Kind::plane && other.is_vertex) {
        // Anticlockwise as seen from outside: the face `left` lies to the left of its edge.
        for (const auto& [face, sign] : {std::pair(edge.left, 1.0), {edge.right, -1.0}}) {
          const Vec3& normal = hull.faces[static_cast<std::size_t>(face)].normal;
          if (normal.dot(own.direction) > 1 - kAligned)
            least = std::min(least, sign * normal.cross(along).dot(q - from));
        }
      } else if (own.kind == Kind::line && is_on(edge, hull)) {
        least = std::min({least, along.dot(q - from), along.dot(to - q)});
      }
    }
    return least;
  }

  // Its cap, its side and its rims meet with one normal, so that a ball rolls from one to the next. On a plane,
  // of_rim().
  double operator()(const Cylinder& cylinder) const {
    if (other.kind == Kind::plane) return kEndless;
    const double beside = std::hypot(q.x(), q.y()) - cylinder.radius, above = std::abs(q.z()) - 0.5 * cylinder.length;
    if (own.kind == Kind::plane) return -beside;
    return own.kind == Kind::line ? -above : std::min(beside, above);
  }

  double operator()(const SurfaceShape& on) const { return distance_from_end(*on.surface, own, other, q, reach); }

 private:
  bool is_on(const Hull::Edge& edge, const Hull& hull) const {
    const Vec3& from = hull.points[static_cast<std::size_t>(edge.from)];
    const Vec3 along = (hull.points[static_cast<std::size_t>(edge.to)] - from).normalized();
    return along.cross(own.direction).norm() < kOnEdge &&
           along.cross(own.at - from).norm() < kOnEdge * hull.bounding_radius;
  }
};

// m: the sine of a rim's tilt against the plane that it touches, times its radius. Past flat it is negative: the rim
// has turned over.
double of_rim(const ContactFeature& own, const ContactFeature& other, const Mat3& R, const Vec3& outward) {
  if (own.kind != Kind::round || other.kind != Kind::plane || !is_rim(own.half_axes)) return kEndless;
  const Mat3 half_axes = R * own.half_axes;
  const Vec3 across = half_axes.transpose() * outward;
  return std::copysign(across.norm(), (half_axes * across).dot(own.direction));
}

}  // namespace

double distance_from_ends(const FeaturePair& features, const ContactKinematics& kinematics, const Collider& a,
                          const Pose& pose_a, const Collider& b, const Pose& pose_b) {
  const Vec3 of_a = kinematics.point + (0.5 * kinematics.gap + features.a.radius) * kinematics.normal,
             of_b = kinematics.point - (0.5 * kinematics.gap + features.b.radius) * kinematics.normal;
  const Vec3 in_a = pose_a.R.transpose() * (of_b - pose_a.p), in_b = pose_b.R.transpose() * (of_a - pose_b.p);
  const double reach = std::min(a.bounding_radius, b.bounding_radius);
  const Vec3& n = kinematics.normal;
  return std::min({std::visit(EndsOf{features.a, features.b, in_a, reach}, a.shape),
                   std::visit(EndsOf{features.b, features.a, in_b, reach}, b.shape),
                   of_rim(features.a, features.b, pose_a.R, -n), of_rim(features.b, features.a, pose_b.R, n)});
}

}  // namespace rigor::inline dynamics
