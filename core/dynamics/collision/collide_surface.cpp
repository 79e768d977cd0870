// Balls, capsules, boxes and hulls on surfaces of triangles. Each is points, edges and faces, the first two with a
// radius around them. The pairs of features that touch:
//
//   point on a triangle; peak on a face; ridge across an edge; with a radius also point and edge on a ridge or a peak
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/dynamics/collision/placed_hull.h"
#include "core/dynamics/collision/surface_contacts.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// A convex shape in the surface's frame.
struct RoundHull {
  std::vector<Vec3> points;
  struct Edge {
    int from, to;
    Vec3 into_left = Vec3::Zero(), into_right = Vec3::Zero();  // unit, along the faces; zero for an edge without faces
  };
  std::vector<Edge> edges;
  double radius = 0;    // m, around all of these
  double inradius = 0;  // m
  Vec3 centre;
  const PlacedHull* faces = nullptr;

  Vec3 along(const Edge& edge) const { return points[edge.to] - points[edge.from]; }
};

class OnSurface : SurfaceContacts {
 public:
  OnSurface(const TriangleSurface& surface, const RoundHull& shape)
      : SurfaceContacts(surface, shape.inradius), shape_(shape) {}

  // Nearest or not, all within `reach` [m].
  const std::vector<SurfaceTouch>& find(double reach) {
    Vec3 low = shape_.points.front(), high = low;
    for (const Vec3& point : shape_.points) low = low.cwiseMin(point), high = high.cwiseMax(point);
    const Vec3 around = Vec3::Constant(shape_.radius);
    look_around(low - around, high + around, reach);
    visit_near([&](int t) { points_on(t); }, [&](int peak) { on_peak(peak); }, [&](int ridge) { on_ridge(ridge); });
    return touches_;
  }

 private:
  void points_on(int t) {
    const TriangleSurface::Triangle& triangle = surface_.triangles[index_of(t)];
    if (!(triangle.normal.dot(shape_.centre - point(triangle.corners[0])) > 0)) return;
    for (std::size_t i = 0; i < shape_.points.size(); ++i)
      add_point(t, shape_.points[i], shape_.radius, static_cast<std::uint32_t>(i));
  }

  using SurfaceContacts::points_out_of;
  static bool points_out_of(const RoundHull::Edge& edge, const Vec3& n) {
    return n.dot(edge.into_left) <= kNearlyFlat && n.dot(edge.into_right) <= kNearlyFlat;
  }

  void on_peak(int number) {
    const TriangleSurface::Peak& peak = surface_.peaks[index_of(number)];
    const Vec3& q = point(peak.point);
    const std::uint32_t tag = 0x40000000u ^ static_cast<std::uint32_t>(number) * 0x85EBCA77u;
    if (shape_.faces) return peak_on_faces(number, peak, q, tag);
    for (std::size_t i = 0; i < shape_.points.size(); ++i)
      ball_on(q, shape_.points[i], tag ^ static_cast<std::uint32_t>(i), beyond_patches(number),
              [&](const Vec3& n) { return strictly_out_of(peak, n); });
    for (const RoundHull::Edge& edge : shape_.edges) {
      const Vec3 &from = shape_.points[index_of(edge.from)], along = shape_.along(edge);
      const double share = along.dot(q - from) / along.squaredNorm();
      if (share <= 0 || share >= 1) continue;
      ball_on(q, from + share * along, tag ^ 0x100u, beyond_patches(number),
              [&](const Vec3& n) { return strictly_out_of(peak, n); });
    }
  }

  template <typename IsOut>
  void ball_on(const Vec3& foot, const Vec3& centre, std::uint32_t feature, int patch, const IsOut& is_out) {
    const Vec3 line = centre - foot;
    const double distance = line.norm();
    if (distance > 0 && is_out(line / distance)) add(line / distance, foot, distance - shape_.radius, feature, patch);
  }

  void peak_on_faces(int number, const TriangleSurface::Peak& peak, const Vec3& q, std::uint32_t tag) {
    const PlacedHull& hull = *shape_.faces;
    const auto gap_of = [&](std::size_t f) { return hull.normals[f].dot(q) - hull.offsets[f]; };
    const double most = most_above(q);
    for (std::size_t f = 0; f < hull.normals.size(); ++f) {
      const double gap = gap_of(f);
      if (gap > reach_ || gap < most - slop() || !points_out_of(peak, -hull.normals[f]) ||
          !(hull.normals[f].dot(shape_.centre - q) < 0))
        continue;
      if (!is_over(hull, f, q - gap * hull.normals[f])) continue;
      add(-hull.normals[f], q, gap, tag ^ static_cast<std::uint32_t>(f), patch_beside(peak, -hull.normals[f], number));
    }
  }

  static bool is_over(const PlacedHull& hull, std::size_t f, const Vec3& foot) {
    const std::vector<int>& corners = hull.hull->faces[f].corners;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vec3 &from = hull.points[index_of(corners[k])],
                 side = hull.points[index_of(corners[(k + 1) % corners.size()])] - from;
      if (hull.normals[f].dot(side.cross(foot - from)) < -kOnTriangle * side.squaredNorm()) return false;
    }
    return true;
  }

  void on_ridge(int number) {
    const TriangleSurface::Ridge& ridge = surface_.ridges[index_of(number)];
    const Vec3 &from = point(ridge.from), along = point(ridge.to) - from;
    const std::uint32_t tag = 0x20000000u ^ static_cast<std::uint32_t>(number) * 0xC2B2AE3Du;
    const int own_patch = beyond_patches(static_cast<int>(surface_.peaks.size()) + number);
    for (std::size_t k = 0; k < shape_.edges.size(); ++k)
      ridge_on_edge(ridge, from, along, shape_.edges[k], tag ^ static_cast<std::uint32_t>(k), own_patch);
    if (shape_.faces) return;
    for (std::size_t i = 0; i < shape_.points.size(); ++i) {
      const double share = along.dot(shape_.points[i] - from) / along.squaredNorm();
      if (share < 0 || share > 1) continue;
      ball_on(from + share * along, shape_.points[i], tag ^ 0x1000u ^ static_cast<std::uint32_t>(i), own_patch,
              [&](const Vec3& n) { return strictly_out_of(ridge, n); });
    }
  }

  void ridge_on_edge(const TriangleSurface::Ridge& ridge, const Vec3& from, const Vec3& u, const RoundHull::Edge& edge,
                     std::uint32_t feature, int own_patch) {
    const Vec3 &start = shape_.points[index_of(edge.from)], v = shape_.along(edge), across = u.cross(v);
    const double length = across.norm();
    if (!(length > kAcross * u.norm() * v.norm())) return;
    for (const double side : {1.0, -1.0}) {
      const Vec3 n = side / length * across;
      if (!points_out_of(ridge, n) || !points_out_of(edge, -n) || !(n.dot(shape_.centre - from) > 0)) continue;
      const Vec3 line = start - from;
      const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), both = uu * vv - uv * uv;
      const double s = (vv * u.dot(line) - uv * v.dot(line)) / both, t = (uv * u.dot(line) - uu * v.dot(line)) / both;
      if (s < 0 || s > 1 || t < 0 || t > 1) continue;
      if (n.dot(start + t * v - from - s * u) < -slop() && is_false_overlap(from + s * u, start + t * v)) continue;
      add_crossing(ridge, n, from + s * u, start + t * v, shape_.radius, feature, own_patch);
    }
  }

  // Whether two edges that have passed each other are not inside each other: then they lie on different sides of a
  // body.
  bool is_false_overlap(const Vec3& foot, const Vec3& own) const {
    if (shape_.faces && most_above(foot) > 0) return true;
    return (own - foot).norm() > nearest_to(own) + slop();
  }

  // m, of a point above the faces of a hull; negative inside.
  double most_above(const Vec3& q) const {
    const PlacedHull& hull = *shape_.faces;
    double most = -kFar;
    for (std::size_t f = 0; f < hull.normals.size(); ++f)
      most = std::max(most, hull.normals[f].dot(q) - hull.offsets[f]);
    return most;
  }

  const RoundHull& shape_;
};

// `size`: m, of the shape from its centre.
void collide_round(const RoundHull& shape, double size, const TriangleSurface& surface, const Pose& of_surface,
                   Manifold& out) {
  if (!surface.nearest(shape.centre, 2 * size).allFinite()) return;  // far away
  OnSurface on(surface, shape);
  add_touches(out, on.find(size), of_surface);
}

RoundHull round_hull_of(const PlacedHull& placed) {
  RoundHull shape;
  shape.points = placed.points, shape.faces = &placed, shape.centre = placed.centre, shape.inradius = placed.inradius;
  for (const Hull::Edge& edge : placed.hull->edges) {
    const Vec3 along = placed.edge(edge).normalized();
    shape.edges.push_back(
        {edge.from, edge.to, placed.normals[edge.left].cross(along), along.cross(placed.normals[edge.right])});
  }
  return shape;
}

template <typename Polyhedron>
void collide_polyhedron(const Polyhedron& a, const Pose& pose_a, const TriangleSurface& surface, const Pose& pose_b,
                        Manifold& out) {
  static thread_local PlacedHull placed;
  placed.place(a, seen_from(pose_b, pose_a));
  const RoundHull shape = round_hull_of(placed);
  double size = 0;
  for (const Vec3& point : shape.points) size = std::max(size, (point - shape.centre).norm());
  collide_round(shape, size, surface, pose_b, out);
}

}  // namespace

void add_touches(Manifold& out, std::vector<SurfaceTouch> touches, const Pose& of_surface) {
  std::stable_sort(touches.begin(), touches.end(),
                   [](const SurfaceTouch& x, const SurfaceTouch& y) { return x.gap < y.gap; });
  if (touches.size() > Manifold::kMost) touches.resize(Manifold::kMost);
  std::stable_sort(touches.begin(), touches.end(),
                   [](const SurfaceTouch& x, const SurfaceTouch& y) { return x.patch < y.patch; });
  std::uint16_t region = 0;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const SurfaceTouch& touch = touches[i];
    if (i > 0 && touch.patch != touches[i - 1].patch) ++region;
    const Vec3 n = of_surface.R * touch.normal;
    out.add({n, of_surface.p + of_surface.R * touch.foot + 0.5 * touch.gap * n, touch.gap, touch.feature, 0, region});
  }
}

void collide_surface(const Box& a, const Pose& pose_a, const TriangleSurface& b, const Pose& pose_b, Manifold& out) {
  collide_polyhedron(a, pose_a, b, pose_b, out);
}

void collide_surface(const Convex& a, const Pose& pose_a, const TriangleSurface& b, const Pose& pose_b, Manifold& out) {
  collide_polyhedron(a, pose_a, b, pose_b, out);
}

void collide_surface(const Capsule& a, const Pose& pose_a, const TriangleSurface& b, const Pose& pose_b,
                     Manifold& out) {
  const Pose at = seen_from(pose_b, pose_a);
  const Vec3 half = 0.5 * a.length * at.R.col(2);
  RoundHull shape;
  shape.points = {at.p - half, at.p + half}, shape.edges = {{0, 1}};
  shape.radius = shape.inradius = a.radius, shape.centre = at.p;
  collide_round(shape, a.bounding_radius(), b, pose_b, out);
}

void collide_surface(const Sphere& a, const Pose& pose_a, const TriangleSurface& b, const Pose& pose_b, Manifold& out) {
  RoundHull shape;
  shape.centre = seen_from(pose_b, pose_a).p, shape.points = {shape.centre};
  shape.radius = shape.inradius = a.radius;
  collide_round(shape, a.radius, b, pose_b, out);
}

}  // namespace rigor::inline dynamics
