// Two boxes: the axis of largest separation, among the three face normals of each box and the nine products of their
// edges (Gottschalk, Lin, Manocha, OBBTree, 1996). Face against face: the incident face is clipped by the sides of the
// reference face (Sutherland and Hodgman), and each remaining corner has its own gap. Edge against edge: the nearest
// points of both edges.
#include <algorithm>
#include <limits>

#include "core/dynamics/collision/narrow_phase.h"

namespace rigor::inline dynamics {
namespace {

// An edge pair must be separated further than the best face by this share of the smallest half-length. The edges of
// touching faces give the same separation up to rounding; such contacts then count as faces.
constexpr double kFacePreference = 1e-5;
// A face is clipped this share of its half-length outside the sides of the other face. Edges that lie on each other
// then keep their corners, regardless of rounding.
constexpr double kOutside = 1e-6;

struct Axis {
  double separation = -std::numeric_limits<double>::infinity();
  Vec3 n = Vec3::Zero();  // unit, in W, from b to a
  int edge_a = -1, edge_b = -1;
};

struct BoxInSpace {
  Vec3 half;  // m
  const Pose& pose;
  double extent(const Vec3& n) const { return (pose.R.transpose() * n).cwiseAbs().dot(half); }
};

double separation_along(const Vec3& n, const BoxInSpace& a, const BoxInSpace& b) {
  return n.dot(a.pose.p - b.pose.p) - a.extent(n) - b.extent(n);
}

Axis best_face(const BoxInSpace& of, const BoxInSpace& a, const BoxInSpace& b) {
  Axis best;
  const Vec3 line = a.pose.p - b.pose.p;
  for (int k = 0; k < 3; ++k) {
    Vec3 n = of.pose.R.col(k);
    if (n.dot(line) < 0) n = -n;
    const double separation = separation_along(n, a, b);
    if (separation > best.separation) best = {separation, n};
  }
  return best;
}

Axis best_edges(const BoxInSpace& a, const BoxInSpace& b) {
  constexpr double kParallel = 1e-6;  // the sine squared: such edges' product is a face normal, or noise
  Axis best;
  const Vec3 line = a.pose.p - b.pose.p;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Vec3 n = a.pose.R.col(i).cross(b.pose.R.col(j));
      const double sine2 = n.squaredNorm();
      if (sine2 < kParallel) continue;
      n /= (n.dot(line) < 0 ? -1 : 1) * std::sqrt(sine2);
      const double separation = separation_along(n, a, b);
      if (separation > best.separation) best = {separation, n, i, j};
    }
  }
  return best;
}

struct Corner {
  Vec3 p;
  std::uint32_t id;
};

// A convex polygon of at most eight corners: a quadrilateral cut by four half-spaces.
struct Polygon {
  std::array<Corner, 12> corners;
  int count = 0;
  void add(const Vec3& p, std::uint32_t id) { corners[count++] = {p, id}; }
};

std::uint32_t crossing_id(std::uint32_t from, std::uint32_t to, std::uint32_t side) {
  const std::uint32_t low = std::min(from, to), high = std::max(from, to);
  return (low * 0x9E3779B1u) ^ (high * 0x85EBCA77u) ^ ((side + 1) * 0xC2B2AE3Du);
}

// The half-space n · p <= offset.
Polygon clipped(const Polygon& polygon, const Vec3& n, double offset, std::uint32_t side) {
  Polygon out;
  for (int i = 0; i < polygon.count; ++i) {
    const Corner& from = polygon.corners[i];
    const Corner& to = polygon.corners[(i + 1) % polygon.count];
    const double d_from = n.dot(from.p) - offset, d_to = n.dot(to.p) - offset;
    if (d_from <= 0) out.add(from.p, from.id);
    if ((d_from < 0 && d_to > 0) || (d_from > 0 && d_to < 0)) {
      out.add(from.p + d_from / (d_from - d_to) * (to.p - from.p), crossing_id(from.id, to.id, side));
    }
  }
  return out;
}

// The face of the box that looks most against n.
Polygon facing(const BoxInSpace& box, const Vec3& n) {
  const Vec3 n_B = box.pose.R.transpose() * n;
  int axis = 0;
  n_B.cwiseAbs().maxCoeff(&axis);
  const double sign = n_B[axis] > 0 ? -1 : 1;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Polygon face;
  for (int k = 0; k < 4; ++k) {
    Vec3 corner;
    corner[axis] = sign * box.half[axis];
    corner[u] = (k == 1 || k == 2 ? 1 : -1) * box.half[u];
    corner[v] = (k >= 2 ? 1 : -1) * box.half[v];
    const std::uint32_t id = (corner[0] > 0) | (corner[1] > 0) << 1 | (corner[2] > 0) << 2;
    face.add(box.pose.p + box.pose.R * corner, id);
  }
  return face;
}

// The corners of the incident face over the reference face, with their gaps along `outward`. It looks from the
// reference box to the incident one.
struct FaceCorners {
  Polygon face;
  std::array<double, 12> gaps;
  double least = std::numeric_limits<double>::infinity();

  FaceCorners(const BoxInSpace& reference, const BoxInSpace& incident, const Vec3& outward)
      : face(facing(incident, outward)) {
    const Vec3 out_B = reference.pose.R.transpose() * outward;
    int axis = 0;
    out_B.cwiseAbs().maxCoeff(&axis);
    for (int k = 1; k <= 2; ++k) {
      const int side = (axis + k) % 3;
      for (const int sign : {1, -1}) {
        const Vec3 side_n = sign * reference.pose.R.col(side);
        face = clipped(face, side_n, side_n.dot(reference.pose.p) + (1 + kOutside) * reference.half[side],
                       static_cast<std::uint32_t>(2 * side + (sign > 0)));
      }
    }
    const double level = outward.dot(reference.pose.p) + reference.half[axis];
    for (int i = 0; i < face.count; ++i)
      gaps[i] = outward.dot(face.corners[i].p) - level, least = std::min(least, gaps[i]);
  }
  // `n` looks from b to a.
  void add(const Vec3& outward, const Vec3& n, std::uint32_t tag, Manifold& out) const {
    for (int i = 0; i < face.count; ++i)
      out.add(n, face.corners[i].p - 0.5 * gaps[i] * outward, gaps[i], face.corners[i].id ^ tag);
  }
};

void add_face_contact(const BoxInSpace& reference, const BoxInSpace& incident, const Vec3& outward, const Vec3& n,
                      double separation, std::uint32_t tag, Manifold& out) {
  const FaceCorners corners(reference, incident, outward);
  const bool is_over = separation <= 0 || corners.least <= separation + kOutside * reference.half.minCoeff();
  if (corners.face.count > 0 && is_over) return corners.add(outward, n, tag, out);
  // Apart, and its deepest corner past the other's face: that corner stands for the pair.
  const Vec3 n_B = incident.pose.R.transpose() * outward;
  const Vec3 corner = incident.pose.p - incident.pose.R * n_B.cwiseSign().cwiseProduct(incident.half);
  out.add(n, corner - 0.5 * separation * outward, separation, tag);
}

// The middle of the box's edge along axis k that lies furthest along `direction`.
Vec3 edge_middle(const BoxInSpace& box, int k, const Vec3& direction) {
  Vec3 local = (box.pose.R.transpose() * direction).cwiseSign().cwiseProduct(box.half);
  local[k] = 0;
  return box.pose.p + box.pose.R * local;
}

ManifoldPoint edge_contact(const BoxInSpace& a, const BoxInSpace& b, const Axis& axis) {
  const Vec3 u = a.pose.R.col(axis.edge_a), v = b.pose.R.col(axis.edge_b);
  const Vec3 from_a = edge_middle(a, axis.edge_a, -axis.n), from_b = edge_middle(b, axis.edge_b, axis.n);
  const Vec3 line = from_b - from_a;
  const double cosine = u.dot(v), sine2 = u.cross(v).squaredNorm();
  const double s = std::clamp((u.dot(line) - cosine * v.dot(line)) / sine2, -a.half[axis.edge_a], a.half[axis.edge_a]);
  const double t = std::clamp((cosine * u.dot(line) - v.dot(line)) / sine2, -b.half[axis.edge_b], b.half[axis.edge_b]);
  const Vec3 point = 0.5 * (from_a + s * u + from_b + t * v);
  return {axis.n, point, axis.separation, static_cast<std::uint32_t>(0x200 + 3 * axis.edge_a + axis.edge_b), 0, 0};
}

bool add_nearly_flat(const BoxInSpace& a, const BoxInSpace& b, const Axis& face, const ManifoldPoint& crossing,
                     bool is_of_a, Manifold& out) {
  if (face.n.cross(crossing.normal).norm() > kNearlyFlat) return false;
  const BoxInSpace &reference = is_of_a ? a : b, &incident = is_of_a ? b : a;
  const Vec3 outward = is_of_a ? Vec3(-face.n) : face.n;
  const int first = out.size();
  FaceCorners(reference, incident, outward).add(outward, face.n, is_of_a ? 0x2000 : 0x1000, out);
  const double size = std::min(a.half.minCoeff(), b.half.minCoeff());
  return put_crossing(crossing, kNearlyFlat * size + std::abs(crossing.gap), first, out);
}

}  // namespace

void collide_boxes(const Box& box_a, const Pose& pose_a, const Box& box_b, const Pose& pose_b, Manifold& out) {
  const BoxInSpace a{0.5 * box_a.size, pose_a}, b{0.5 * box_b.size, pose_b};
  const double preference = kFacePreference * std::min(a.half.minCoeff(), b.half.minCoeff());
  const Axis face_a = best_face(a, a, b), face_b = best_face(b, a, b), edges = best_edges(a, b);
  if (edges.separation > std::max(face_a.separation, face_b.separation) + preference) {
    const bool is_of_a = edges.n.dot(face_a.n) >= edges.n.dot(face_b.n);
    const ManifoldPoint crossing = edge_contact(a, b, edges);
    if (!add_nearly_flat(a, b, is_of_a ? face_a : face_b, crossing, is_of_a, out)) out.add(crossing);
  } else if (face_b.separation > face_a.separation + preference) {
    add_face_contact(b, a, face_b.n, face_b.n, face_b.separation, 0x1000, out);
  } else {
    add_face_contact(a, b, -face_a.n, face_a.n, face_a.separation, 0x2000, out);
  }
}

}  // namespace rigor::inline dynamics
