#include "core/dynamics/contact/event/clearance/ground_gap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/dynamics/collision/placed_hull.h"
#include "core/dynamics/collision/side_by_side.h"

namespace rigor::inline dynamics {
namespace {

// Outwards at a point of a surface: the mean of the normals around it, weighed by the angles of the triangles
// (Baerentzen, Aanaes, Signed distance computation using the angle weighted pseudonormal, 2005). A point that is
// nearest to this one is outside if it lies along this direction.
Vec3 pseudonormal(const TriangleSurface& surface, const Vec3& at) {
  constexpr double kAt = 1e-12;  // of the surface's size
  const double near_by = kAt * surface.bounding_radius;
  const Vec3 margin = Vec3::Constant(near_by);
  std::vector<int> near;
  surface.find_near(at - margin, at + margin, near);
  Vec3 sum = Vec3::Zero();
  for (const int t : near) {
    const TriangleSurface::Triangle& triangle = surface.triangles[t];
    if ((surface.nearest_on(triangle, at) - at).norm() > near_by) continue;
    double angle = std::numbers::pi;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& corner = surface.points[triangle.corners[k]];
      if ((corner - at).norm() > near_by) continue;
      const Vec3 u = surface.points[triangle.corners[(k + 1) % 3]] - corner,
                 v = surface.points[triangle.corners[(k + 2) % 3]] - corner;
      angle = portable::atan2(u.cross(v).norm(), u.dot(v));
    }
    sum += angle * triangle.normal;
  }
  return sum;
}

// m: the largest depth of a point of the line p + s u, 0 <= s <= 1, below all faces of a hull; negative outside. It is
// the maximum of the least of linear functions of s, between one that rises and one that falls.
double depth_of_line(const PlacedHull& hull, const Vec3& p, const Vec3& u) {
  struct Line {
    double at, slope;
  };
  const auto least_at = [&](double s) {
    Line least{std::numeric_limits<double>::infinity(), 0};
    for (std::size_t f = 0; f < hull.normals.size(); ++f) {
      const double slope = -hull.normals[f].dot(u), depth = hull.offsets[f] - hull.normals[f].dot(p) + s * slope;
      if (depth < least.at) least = {depth, slope};
    }
    return least;
  };
  constexpr int kMostRounds = 100;
  double low = 0, high = 1;
  Line rises = least_at(low), falls = least_at(high);
  if (rises.slope <= 0) return rises.at;
  if (falls.slope >= 0) return falls.at;
  for (int round = 0; round < kMostRounds; ++round) {
    const double s = (falls.at - falls.slope * high - rises.at + rises.slope * low) / (rises.slope - falls.slope),
                 bound = rises.at + rises.slope * (s - low);
    const Line least = least_at(s);
    if (!(least.at < bound) || !(s > low && s < high)) return least.at;
    (least.slope > 0 ? rises : falls) = least, (least.slope > 0 ? low : high) = s;
  }
  return rises.at;
}

// One part of a body, in the surface's frame.
struct GapOf {
  const TriangleSurface& surface;
  const Pose& at;
  double reach;  // m: overlaps that are deeper, and corners that are farther, are not looked for
  double least = std::numeric_limits<double>::infinity();

  void operator()(const Sphere& sphere) { add_ball(at.p, sphere.radius); }
  void operator()(const Box& box) { add_polyhedron(box); }
  void operator()(const Convex& convex) { add_polyhedron(convex); }

  void operator()(const Capsule& capsule) {
    const Vec3 half = 0.5 * capsule.length * at.R.col(2);
    add_ball(at.p - half, capsule.radius), add_ball(at.p + half, capsule.radius);
    const RoundLine axis{at.p, at.R.col(2), 0.5 * capsule.length, 0};
    for_each_ridge(capsule.bounding_radius(), [&](const Vec3& from, const Vec3& line) {
      const double length = line.norm();
      const RoundLine ridge{from + 0.5 * line, line / length, 0.5 * length, 0};
      const auto [s, t] = nearest_on_lines(axis, ridge);
      note((axis.at(s) - ridge.at(t)).norm() - capsule.radius);
    });
  }

  template <typename Other>
  void operator()(const Other&) {}  // no method has this shape on a surface

 private:
  void note(double gap) { least = std::min(least, gap); }

  void add_ball(const Vec3& centre, double radius) {
    const Vec3 nearest = surface.nearest(centre, radius + reach), away = centre - nearest;
    if (!away.allFinite()) return;
    const double distance = away.norm();
    if (distance > radius && distance - radius > least) return;
    note((away.dot(pseudonormal(surface, nearest)) < 0 ? -distance : distance) - radius);
  }

  template <typename Polyhedron>
  void add_polyhedron(const Polyhedron& shape) {
    static thread_local PlacedHull placed;
    placed.place(shape, at);
    double size = 0;
    for (const Vec3& corner : placed.points) {
      add_ball(corner, 0);
      size = std::max(size, (corner - at.p).norm());
    }
    for_each_ridge(size, [&](const Vec3& from, const Vec3& line) { note(-depth_of_line(placed, from, line)); });
  }

  template <typename Visit>
  void for_each_ridge(double size, const Visit& visit) {
    std::vector<int> near;
    surface.find_near(at.p - Vec3::Constant(size), at.p + Vec3::Constant(size), near);
    for (const int t : near) {
      for (const int r : surface.ridges_of[t]) {
        const Vec3& from = surface.points[surface.ridges[r].from];
        visit(from, surface.points[surface.ridges[r].to] - from);
      }
    }
  }
};

}  // namespace

double gap_above_ground(const Collider& body, const Pose& pose, const TriangleSurface& surface,
                        const Pose& of_surface) {
  const Pose seen{of_surface.R.transpose() * (pose.p - of_surface.p), of_surface.R.transpose() * pose.R};
  double least = std::numeric_limits<double>::infinity();
  for_each_part(body.shape, [&](const Shape& part, const BodyPose& in_body) {
    const Pose at = seen * in_body;
    GapOf gap{surface, at, body.inradius};
    std::visit(gap, part);
    least = std::min(least, gap.least);
  });
  return least;
}

}  // namespace rigor::inline dynamics
