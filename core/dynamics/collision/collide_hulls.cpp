// Convex polyhedra with each other, and with the shapes that have a closest point to them in closed form.
//
// Two polyhedra: the axis of largest separation (placed_hull.h). Face against face: the incident face is clipped by the
// sides of the reference face. A box is a polyhedron here.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/dynamics/collision/placed_hull.h"
#include "core/dynamics/collision/side_by_side.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kHullFacePreference =
    1e-5;                              // of the smaller inradius: by how much edges must be further apart than faces
constexpr double kHullOutside = 1e-6;  // of the inradius: a face is clipped so far outside its sides
constexpr int kMostOfFace = 16;        // points of one face contact
constexpr double kFarAway = std::numeric_limits<double>::infinity();

struct HullCorner {
  Vec3 p;
  std::uint32_t id;
};
using HullPolygon = std::vector<HullCorner>;

std::uint32_t hull_crossing(std::uint32_t from, std::uint32_t to, std::uint32_t side) {
  const std::uint32_t low = std::min(from, to), high = std::max(from, to);
  return (low * 0x9E3779B1u) ^ (high * 0x85EBCA77u) ^ ((side + 1) * 0xC2B2AE3Du);
}

// Keeps the half-space n · p <= offset.
void clip(const HullPolygon& polygon, const Vec3& n, double offset, std::uint32_t side, HullPolygon& out) {
  out.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const HullCorner &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double d_from = n.dot(from.p) - offset, d_to = n.dot(to.p) - offset;
    if (d_from <= 0) out.push_back(from);
    if ((d_from < 0 && d_to > 0) || (d_from > 0 && d_to < 0))
      out.push_back({from.p + d_from / (d_from - d_to) * (to.p - from.p), hull_crossing(from.id, to.id, side)});
  }
}

// The corners of the incident face over the reference face, which looks along `axis.n`.
const HullPolygon& clipped_face(const PlacedHull& reference, const PlacedHull& incident, const HullAxis& axis) {
  static thread_local HullPolygon polygon, clipped;
  const int deepest = reference.deepest[PlacedHull::index(axis.a)];
  const Hull::Face& face = incident.hull->faces[facing_at(incident, deepest, axis.n)];
  polygon.clear();
  for (const int corner : face.corners)
    polygon.push_back({incident.points[PlacedHull::index(corner)], static_cast<std::uint32_t>(corner)});
  const Hull::Face& sides = reference.hull->faces[PlacedHull::index(axis.a)];
  for (std::size_t k = 0; k < sides.corners.size() && !polygon.empty(); ++k) {
    const Vec3 &from = reference.points[PlacedHull::index(sides.corners[k])],
               &to = reference.points[PlacedHull::index(sides.corners[(k + 1) % sides.corners.size()])];
    const Vec3 side = (to - from).cross(axis.n).normalized();
    clip(polygon, side, side.dot(from) + kHullOutside * reference.inradius, static_cast<std::uint32_t>(k), clipped);
    polygon.swap(clipped);
  }
  return polygon;
}

// `normal` from b to a.
void add_corners(const HullPolygon& polygon, const PlacedHull& reference, const HullAxis& axis, const Vec3& normal,
                 std::uint32_t tag, Manifold& out) {
  const double level = reference.offsets[PlacedHull::index(axis.a)];
  const std::size_t step = (polygon.size() + kMostOfFace - 1) / kMostOfFace;
  for (std::size_t i = 0; i < polygon.size(); i += step) {
    const double gap = axis.n.dot(polygon[i].p) - level;
    out.add(normal, polygon[i].p - 0.5 * gap * axis.n, gap, polygon[i].id ^ tag);
  }
}

void add_face(const PlacedHull& reference, const PlacedHull& incident, const HullAxis& axis, const Vec3& normal,
              std::uint32_t tag, Manifold& out) {
  const HullPolygon& polygon = clipped_face(reference, incident, axis);
  const double level = reference.offsets[PlacedHull::index(axis.a)];
  double least = kFarAway;
  for (const HullCorner& corner : polygon) least = std::min(least, axis.n.dot(corner.p) - level);
  if (!polygon.empty() && (axis.separation <= 0 || least <= axis.separation + kHullOutside * reference.inradius))
    return add_corners(polygon, reference, axis, normal, tag, out);
  // Apart, and the deepest corner lies past the other's face: that corner stands for the pair.
  const Vec3& corner = incident.points[PlacedHull::index(reference.deepest[PlacedHull::index(axis.a)])];
  out.add(normal, corner - 0.5 * axis.separation * axis.n, axis.separation, tag);
}

ManifoldPoint edge_crossing(const PlacedHull& a, const PlacedHull& b, const HullAxis& axis) {
  const Hull::Edge &of_a = a.hull->edges[PlacedHull::index(axis.a)], &of_b = b.hull->edges[PlacedHull::index(axis.b)];
  const Vec3 u = a.edge(of_a), v = b.edge(of_b);
  const Vec3 &from_a = a.points[PlacedHull::index(of_a.from)], &from_b = b.points[PlacedHull::index(of_b.from)];
  const Vec3 line = from_b - from_a;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), both = uu * vv - uv * uv;
  const double s = std::clamp((vv * u.dot(line) - uv * v.dot(line)) / both, 0.0, 1.0),
               t = std::clamp((uv * u.dot(line) - uu * v.dot(line)) / both, 0.0, 1.0);
  const Vec3 point = 0.5 * (from_a + s * u + from_b + t * v);
  const std::uint32_t feature =
      hull_crossing(static_cast<std::uint32_t>(axis.a) + 0x40000u, static_cast<std::uint32_t>(axis.b) + 0x80000u, 0);
  return {-axis.n, point, axis.separation, feature, 0, 0};
}

bool add_nearly_flat(const PlacedHull& reference, const PlacedHull& incident, const HullAxis& face, const Vec3& normal,
                     const ManifoldPoint& crossing, std::uint32_t tag, Manifold& out) {
  if (normal.cross(crossing.normal).norm() > kNearlyFlat) return false;
  const int first = out.size();
  add_corners(clipped_face(reference, incident, face), reference, face, normal, tag, out);
  const double size = std::min(reference.inradius, incident.inradius);
  return put_crossing(crossing, kNearlyFlat * size + std::abs(crossing.gap), first, out);
}

void collide_placed(PlacedHull& a, PlacedHull& b, Manifold& out) {
  const double preference = kHullFacePreference * std::min(a.inradius, b.inradius);
  const HullAxis face_a = best_face_of(a, b), face_b = best_face_of(b, a);
  const double found = std::max(face_a.separation, face_b.separation);
  const HullAxis edges = best_edges_of(a, b, found);
  if (edges.separation > found + preference) {
    const ManifoldPoint crossing = edge_crossing(a, b, edges);
    const bool is_of_a = edges.n.dot(face_a.n) >= -edges.n.dot(face_b.n);
    const bool is_flat = is_of_a ? add_nearly_flat(a, b, face_a, -face_a.n, crossing, 0x20000000, out)
                                 : add_nearly_flat(b, a, face_b, face_b.n, crossing, 0x10000000, out);
    if (!is_flat) out.add(crossing);
    return;
  }
  if (face_b.separation > face_a.separation + preference) return add_face(b, a, face_b, face_b.n, 0x10000000, out);
  add_face(a, b, face_a, -face_a.n, 0x20000000, out);
}

PlacedHull& scratch(int which) {
  static thread_local std::array<PlacedHull, 2> hulls;
  return hulls[static_cast<std::size_t>(which)];
}

// The point of a face that is nearest to p, and whether it lies inside.
Vec3 nearest_on_face(const PlacedHull& hull, std::size_t f, const Vec3& p) {
  const std::vector<int>& corners = hull.hull->faces[f].corners;
  const Vec3& n = hull.normals[f];
  const Vec3 foot = p - (n.dot(p) - hull.offsets[f]) * n;
  bool is_inside = true;
  Vec3 best = foot;
  double least = kFarAway;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 &from = hull.points[PlacedHull::index(corners[k])],
               &to = hull.points[PlacedHull::index(corners[(k + 1) % corners.size()])];
    const Vec3 side = to - from;
    if (side.cross(n).dot(foot - from) > 0) is_inside = false;
    const Vec3 at = from + std::clamp(side.dot(foot - from) / side.squaredNorm(), 0.0, 1.0) * side;
    if (const double square = (at - foot).squaredNorm(); square < least) least = square, best = at;
  }
  return is_inside ? foot : best;
}

// The signed distance of a point from a hull, and the direction out of it.
struct PointGap {
  double distance;  // m
  Vec3 n;           // unit, from the hull to the point
  std::size_t face;
};

PointGap point_to_hull(const PlacedHull& hull, const Vec3& p) {
  std::size_t face = 0;
  double most = -kFarAway;
  for (std::size_t f = 0; f < hull.normals.size(); ++f) {
    if (const double above = hull.normals[f].dot(p) - hull.offsets[f]; above > most) most = above, face = f;
  }
  if (most <= 0) return {most, hull.normals[face], face};
  PointGap best{kFarAway, hull.normals[face], face};
  for (std::size_t f = 0; f < hull.normals.size(); ++f) {
    if (hull.normals[f].dot(p) - hull.offsets[f] <= 0) continue;
    const Vec3 line = p - nearest_on_face(hull, f, p);
    if (const double distance = line.norm(); distance < best.distance) best = {distance, line / distance, f};
  }
  return best;
}

struct CapsuleAxis {
  Vec3 from, to;  // m
  Vec3 along() const { return to - from; }
};

struct AxisGap {
  double separation = -kFarAway;  // m, of the axis
  Vec3 n = Vec3::Zero();          // from the hull to the axis
  Vec3 at = Vec3::Zero();         // of the axis
};

// The least distance of a segment that stays outside: at one of its ends, at a corner, or between it and an edge.
AxisGap outside_gap(const PlacedHull& hull, const CapsuleAxis& axis) {
  AxisGap best;
  best.separation = kFarAway;
  for (const Vec3& end : {axis.from, axis.to}) {
    const PointGap gap = point_to_hull(hull, end);
    if (gap.distance < best.separation) best = {gap.distance, gap.n, end};
  }
  const Vec3 u = axis.along();
  for (const Vec3& corner : hull.points) {
    const Vec3 at = axis.from + std::clamp(u.dot(corner - axis.from) / u.squaredNorm(), 0.0, 1.0) * u;
    if (const double distance = (at - corner).norm(); distance < best.separation && distance > 0)
      best = {distance, (at - corner) / distance, at};
  }
  for (const Hull::Edge& edge : hull.hull->edges) {
    const Vec3 v = hull.edge(edge), line = hull.points[PlacedHull::index(edge.from)] - axis.from;
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), both = uu * vv - uv * uv;
    if (both <= 1e-12 * uu * vv) continue;
    const double s = (vv * u.dot(line) - uv * v.dot(line)) / both, t = (uv * u.dot(line) - uu * v.dot(line)) / both;
    if (s < 0 || s > 1 || t < 0 || t > 1) continue;
    const Vec3 apart = axis.from + s * u - hull.points[PlacedHull::index(edge.from)] - t * v;
    if (const double distance = apart.norm(); distance < best.separation && distance > 0)
      best = {distance, apart / distance, axis.from + s * u};
  }
  return best;
}

// The edge that the axis lies along at the distance that was found; none if another feature is the nearest.
std::optional<RoundLine> edge_beside(const PlacedHull& hull, const RoundLine& capsule, double found) {
  constexpr double kSame = 1e-12;  // of the distance: rounding of two ways to compute it
  std::optional<RoundLine> best;
  double least = found * (1 + kSame);
  for (const Hull::Edge& edge : hull.hull->edges) {
    const Vec3 v = hull.edge(edge);
    const double length = v.norm();
    const RoundLine line{hull.points[PlacedHull::index(edge.from)] + 0.5 * v, v / length, 0.5 * length, 0};
    if (line.direction.cross(capsule.direction).norm() > kNearlyParallelLines) continue;
    const auto [s, t] = nearest_on_lines(capsule, line);
    if (const double distance = (capsule.at(s) - line.at(t)).norm(); distance <= least) least = distance, best = line;
  }
  return best;
}

// Whether the segment has a point inside the hull: what all faces leave of it.
bool enters(const PlacedHull& hull, const CapsuleAxis& axis) {
  double low = 0, high = 1;
  const Vec3 u = axis.along();
  for (std::size_t f = 0; f < hull.normals.size(); ++f) {
    const double at = hull.offsets[f] - hull.normals[f].dot(axis.from), rate = hull.normals[f].dot(u);
    if (rate == 0 && at < 0) return false;
    if (rate > 0) high = std::min(high, at / rate);
    if (rate < 0) low = std::max(low, at / rate);
  }
  return low < high;
}

AxisGap inside_gap(const PlacedHull& hull, const CapsuleAxis& axis) {
  AxisGap best;
  const auto try_direction = [&](const Vec3& n) {
    double reach = -kFarAway;
    for (const Vec3& point : hull.points) reach = std::max(reach, n.dot(point));
    const double from = n.dot(axis.from), to = n.dot(axis.to), separation = std::min(from, to) - reach;
    if (separation > best.separation) best = {separation, n, from < to ? axis.from : axis.to};
  };
  for (const Vec3& n : hull.normals) try_direction(n);
  const Vec3 u = axis.along();
  for (const Hull::Edge& edge : hull.hull->edges) {
    const Vec3 n = u.cross(hull.edge(edge));
    if (n.squaredNorm() < 1e-6 * u.squaredNorm() * hull.edge(edge).squaredNorm()) continue;
    try_direction(n.normalized()), try_direction(-n.normalized());
  }
  return best;
}

// The part of the axis that lies over the face, from 0 to 1.
std::pair<double, double> over_face(const PlacedHull& hull, std::size_t f, const CapsuleAxis& axis) {
  double low = 0, high = 1;
  const Vec3 u = axis.along();
  const std::vector<int>& corners = hull.hull->faces[f].corners;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 &from = hull.points[PlacedHull::index(corners[k])],
               &to = hull.points[PlacedHull::index(corners[(k + 1) % corners.size()])];
    const Vec3 out = (to - from).cross(hull.normals[f]);
    const double at = out.dot(from - axis.from), rate = out.dot(u);
    if (rate == 0 && at < 0) return {1, 0};
    if (rate > 0) high = std::min(high, at / rate);
    if (rate < 0) low = std::max(low, at / rate);
  }
  return {low, high};
}

}  // namespace

void collide_hulls(const Convex& a, const Pose& pose_a, const Convex& b, const Pose& pose_b, Manifold& out) {
  scratch(0).place(a, pose_a), scratch(1).place(b, pose_b);
  collide_placed(scratch(0), scratch(1), out);
}

void collide_hulls(const Box& a, const Pose& pose_a, const Convex& b, const Pose& pose_b, Manifold& out) {
  scratch(0).place(a, pose_a), scratch(1).place(b, pose_b);
  collide_placed(scratch(0), scratch(1), out);
}

void collide_hull_sphere(const Convex& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b, Manifold& out) {
  PlacedHull& hull = scratch(0);
  hull.place(a, pose_a);
  const PointGap at = point_to_hull(hull, pose_b.p);
  const double gap = at.distance - b.radius;
  out.add(-at.n, pose_b.p - (b.radius + 0.5 * gap) * at.n, gap, 0);
}

void collide_hull_plane(const Convex& a, const Pose& pose_a, const Plane& b, Manifold& out) {
  constexpr std::size_t kMostCorners = 32;
  constexpr double kNear = 0.1;  // of the inradius above the lowest corner
  const std::vector<Vec3>& points = a.hull->points;
  const Vec3 n_B = pose_a.R.transpose() * b.normal;
  const double base = b.normal.dot(pose_a.p) - b.offset;
  const auto gap_of = [&](std::size_t i) { return base + n_B.dot(points[i]); };
  double bound = kFarAway;
  std::size_t count = points.size();
  if (points.size() > kMostCorners) {
    bound = gap_of(a.hull->furthest(-n_B)) + kNear * a.hull->inradius, count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) count += gap_of(i) <= bound;
  }
  const std::size_t step = (count + kMostCorners - 1) / kMostCorners;
  std::size_t number = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double gap = gap_of(i);
    if (gap > bound || number++ % step != 0) continue;
    out.add(b.normal, pose_a.p + pose_a.R * points[i] - 0.5 * gap * b.normal, gap, static_cast<std::uint32_t>(i));
  }
}

void collide_capsule_hull(const Capsule& a, const Pose& pose_a, const Convex& b, const Pose& pose_b, Manifold& out) {
  PlacedHull& hull = scratch(1);
  hull.place(b, pose_b);
  const Vec3 half = 0.5 * a.length * pose_a.R.col(2);
  const CapsuleAxis axis{pose_a.p - half, pose_a.p + half};
  const bool is_inside = enters(hull, axis);
  const AxisGap best = is_inside ? inside_gap(hull, axis) : outside_gap(hull, axis);
  const auto add = [&](const Vec3& at, double height, std::uint32_t feature) {
    const double gap = height - a.radius;
    out.add(best.n, at - (a.radius + 0.5 * gap) * best.n, gap, feature);
  };
  constexpr double kStraight = 1 - 1e-12, kAlong = 0.1;  // the cosine; the sine of the axis to the face
  const std::size_t face = facing_of(hull, -best.n);
  if (hull.normals[face].dot(best.n) > kStraight && std::abs(hull.normals[face].dot(pose_a.R.col(2))) < kAlong) {
    const auto [low, high] = over_face(hull, face, axis);
    if (low < high) {
      for (const std::uint32_t end : {0u, 1u}) {
        const Vec3 at = axis.from + (end ? high : low) * axis.along();
        add(at, hull.normals[face].dot(at) - hull.offsets[face], end);
      }
      return;
    }
  }
  const RoundLine line{pose_a.p, pose_a.R.col(2), 0.5 * a.length, a.radius};
  const auto edge = is_inside ? std::nullopt : edge_beside(hull, line, best.separation);
  if (edge && add_side_by_side(line, *edge, out)) return;
  add(best.at, best.separation, 2);
}

}  // namespace rigor::inline dynamics
