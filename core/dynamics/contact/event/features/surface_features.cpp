#include "core/dynamics/contact/event/features/surface_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rigor::inline dynamics {
namespace {

using Kind = ContactFeature::Kind;

constexpr double kInTriangle = 1e-9;  // of its size: a point on the seam of two triangles is in one at least

// The triangles around one point of a surface.
class NearPoint {
 public:
  NearPoint(const TriangleSurface& surface, const Vec3& at, double reach) : surface_(surface) {
    const Vec3 margin = Vec3::Constant(reach);
    surface.find_near(at - margin, at + margin, triangles_);
    std::sort(triangles_.begin(), triangles_.end());
  }
  // Those on which the point counts.
  NearPoint(const TriangleSurface& surface, const Vec3& at)
      : NearPoint(surface, at, kOnEdge * surface.bounding_radius) {
    std::erase_if(triangles_, [&](int t) {
      const double distance = (surface.nearest_on(surface.triangles[t], at) - at).norm();
      return !(distance <= kOnEdge * surface.bounding_radius);
    });
  }

  const std::vector<int>& triangles() const { return triangles_; }

  template <typename Visit>
  void for_each_ridge(const Visit& visit) const {
    for (const int t : triangles_)
      for (const int ridge : surface_.ridges_of[t]) visit(ridge, surface_.ridges[ridge]);
  }

  // The number of the nearest corner that ridges end at, within `most` [m] of p; or -1.
  int nearest_peak(const Vec3& p, double most) const {
    int nearest = -1;
    for (const int t : triangles_) {
      for (const int peak : surface_.peaks_of[t]) {
        const double distance = (surface_.points[surface_.peaks[peak].point] - p).norm();
        if (distance <= most) most = distance, nearest = peak;
      }
    }
    return nearest;
  }

 private:
  const TriangleSurface& surface_;
  std::vector<int> triangles_;
};

ContactFeature plane_of(const TriangleSurface& surface, int t) {
  const TriangleSurface::Triangle& triangle = surface.triangles[t];
  return {.kind = Kind::plane, .at = surface.points[triangle.corners[0]], .direction = triangle.normal, .place = t};
}

ContactFeature line_of(const TriangleSurface& surface, int ridge, const TriangleSurface::Ridge& at) {
  const Vec3& from = surface.points[at.from];
  return {.kind = Kind::line, .at = from, .direction = (surface.points[at.to] - from).normalized(), .place = ridge};
}

ContactFeature point_of(const TriangleSurface& surface, int peak) {
  return {.at = surface.points[surface.peaks[peak].point], .is_vertex = true, .place = peak};
}

// m, along the ridge from its start, and its length.
std::pair<double, double> place_along(const TriangleSurface& surface, const TriangleSurface::Ridge& ridge,
                                      const Vec3& p) {
  const Vec3 &from = surface.points[ridge.from], line = surface.points[ridge.to] - from;
  const double length = line.norm();
  return {line.dot(p - from) / length, length};
}

// Whether a body can pass over a triangle's edge into the air. Beyond a reentrant edge the next triangle stops it.
bool is_open_edge(const TriangleSurface& surface, const TriangleSurface::Triangle& triangle, std::size_t k) {
  if (triangle.beside[k] < 0) return true;
  const TriangleSurface::Triangle& beside = surface.triangles[triangle.beside[k]];
  const auto far = std::find_if(beside.corners.begin(), beside.corners.end(), [&](int corner) {
    return std::find(triangle.corners.begin(), triangle.corners.end(), corner) == triangle.corners.end();
  });
  const Vec3 line = surface.points[*far] - surface.points[triangle.corners[k]];
  return beside.patch != triangle.patch && triangle.normal.dot(line) < 0;
}

// m: of a point in a patch's plane from where the patch ends, negative outside; at most `reach` either way.
double inside_patch(const TriangleSurface& surface, int patch, const Vec3& p, double reach) {
  const NearPoint near(surface, p, reach);
  bool is_inside = false;
  bool is_nearest_end = false;
  double least = reach, side_of_nearest = 1;
  for (const int t : near.triangles()) {
    const TriangleSurface::Triangle& triangle = surface.triangles[t];
    if (triangle.patch != patch) continue;
    bool is_in_triangle = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &from = surface.points[triangle.corners[k]],
                 line = surface.points[triangle.corners[(k + 1) % 3]] - from;
      const double side = triangle.normal.dot(line.cross(p - from));  // left of the edge is inside
      is_in_triangle = is_in_triangle && side >= -kInTriangle * line.squaredNorm();
      if (!is_open_edge(surface, triangle, k)) continue;
      const double share = std::clamp(line.dot(p - from) / line.squaredNorm(), 0.0, 1.0);
      const Vec3 away = p - from - share * line;
      const double distance = (away - triangle.normal * triangle.normal.dot(away)).norm();
      if (distance < least || (distance == least && side < side_of_nearest)) {
        least = distance, side_of_nearest = side;
        is_nearest_end = share <= 0 || share >= 1;
      }
    }
    is_inside = is_inside || is_in_triangle;
  }
  // At a corner of a region that is not convex, a point inside may lie on the right of one edge.
  const bool is_left = side_of_nearest >= 0 || (is_nearest_end && is_inside);
  return is_left ? least : -least;
}

}  // namespace

void find_patches_at(const TriangleSurface& surface, const Vec3& at, std::vector<int>& out) {
  const NearPoint near(surface, at);
  for (const int t : near.triangles()) out.push_back(surface.triangles[t].patch);
}

Choices choices_on_surface(const TriangleSurface& surface, const Vec3& at, const Vec3& normal) {
  const NearPoint near(surface, at);
  const double on_edge = kOnEdge * surface.bounding_radius;
  Choices choices;
  choices.point.at = at;
  double least = std::numeric_limits<double>::infinity();
  for (const int t : near.triangles()) {
    const TriangleSurface::Triangle& triangle = surface.triangles[t];
    if (!(triangle.normal.dot(normal) > 1 - kAligned)) continue;
    const double distance = (surface.nearest_on(triangle, at) - at).norm();
    if (distance < least) least = distance, choices.plane = plane_of(surface, t);
  }
  if (const int peak = near.nearest_peak(at, on_edge); peak >= 0) {
    choices.point = point_of(surface, peak);
    return choices;
  }
  near.for_each_ridge([&](int r, const TriangleSurface::Ridge& ridge) {
    const auto [along, length] = place_along(surface, ridge, at);
    const ContactFeature line = line_of(surface, r, ridge);
    if (along < 0 || along > length || (at - line.at - along * line.direction).norm() > on_edge) return;
    choices.line = line;
    choices.point.at = line.at + along * line.direction;
  });
  return choices;
}

Choices surface_beside_ball(const TriangleSurface& surface, const Vec3& at, const Vec3& centre) {
  const NearPoint near(surface, at);
  const double radius = (centre - at).norm();
  Choices choices;
  choices.point.at = at;
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const int t : near.triangles()) {
    const double distance = (surface.nearest_on(surface.triangles[t], centre) - centre).norm();
    if (distance < least) least = distance, nearest = t;
  }
  if (nearest < 0) return choices;
  const TriangleSurface::Triangle& triangle = surface.triangles[nearest];
  const Vec3 foot = centre - triangle.normal * triangle.normal.dot(centre - surface.points[triangle.corners[0]]);
  if (inside_patch(surface, triangle.patch, foot, radius) > kAtEnd * radius) {
    choices.plane = plane_of(surface, nearest);
    return choices;
  }
  double best = std::numeric_limits<double>::infinity();
  bool is_beside = false;
  near.for_each_ridge([&](int r, const TriangleSurface::Ridge& ridge) {
    const auto [along, length] = place_along(surface, ridge, centre);
    const ContactFeature line = line_of(surface, r, ridge);
    const double distance = (centre - line.at - std::clamp(along, 0.0, length) * line.direction).norm();
    if (!(distance < best)) return;
    best = distance, choices.line = line;
    is_beside = along >= kAtEnd * radius && along <= length - kAtEnd * radius;
  });
  if (is_beside) return choices;
  const int peak = near.nearest_peak(at, kOnEdge * surface.bounding_radius);
  if (peak >= 0) choices.line.reset(), choices.point = point_of(surface, peak);
  if (peak < 0 && !choices.line) choices.plane = plane_of(surface, nearest);  // at the border of a height field
  return choices;
}

double distance_from_end(const TriangleSurface& surface, const ContactFeature& own, const ContactFeature& other,
                         const Vec3& q, double reach) {
  constexpr double kEverywhere = std::numeric_limits<double>::infinity();
  const bool is_beside_round = other.radius > 0;
  if (own.place < 0) return kEverywhere;
  if (own.kind == Kind::plane) {
    if (!other.is_vertex) return kEverywhere;
    return inside_patch(surface, surface.triangles[own.place].patch, q - own.direction * own.direction.dot(q - own.at),
                        reach);
  }
  if (own.kind == Kind::line) {
    const TriangleSurface::Ridge& ridge = surface.ridges[own.place];
    const auto [along, length] = place_along(surface, ridge, q);
    const double within = std::min(along, length - along);
    // Beside a ridge the ball's centre lies in front of both triangles' edges.
    if (!is_beside_round) return within;
    return std::min({within, -ridge.into_left.dot(q - own.at), -ridge.into_right.dot(q - own.at)});
  }
  if (!is_beside_round) return kEverywhere;
  double least = kEverywhere;
  for (const Vec3& edge : surface.peaks[own.place].edges) least = std::min(least, -edge.dot(q - own.at));
  return least;
}

}  // namespace rigor::inline dynamics
