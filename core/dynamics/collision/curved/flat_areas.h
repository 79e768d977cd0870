// Contact over an area or along a line, where a flat end or a straight side of a cylinder lies on a face, an edge, or
// another cylinder. The points are corners of the area: where the rim lies deepest, and at right angles to that; where
// the rim crosses the border of the other shape; and corners of the other shape on the end.
#pragma once

#include <limits>

#include "core/dynamics/collision/curved/curved_solid.h"
#include "core/dynamics/collision/placed_hull.h"

namespace rigor::inline dynamics {

// Takes the points of one area. Each is a point of the upper shape and the one straight below it, along n.
struct AreaPoints {
  Vec3 n;            // unit, from the lower shape to the upper one
  bool is_reversed;  // whether the manifold's normal is -n
  double outside;    // m: so far outside of a border a point still counts
  Manifold& out;
  // m: no gap along n is less. A point a little outside of a steep face would have one, far below the shape itself.
  double least = -std::numeric_limits<double>::infinity();

  void add(const Vec3& upper, const Vec3& lower, std::uint32_t feature) const {
    const double gap = n.dot(upper - lower);
    if (gap >= least) out.add(is_reversed ? Vec3(-n) : n, 0.5 * (upper + lower), gap, feature);
  }
};

// A face of a polyhedron.
struct FlatFace {
  const PlacedHull& hull;
  std::size_t face;

  std::size_t count() const { return hull.hull->faces[face].corners.size(); }
  const Vec3& corner(std::size_t k) const {
    return hull.points[PlacedHull::index(hull.hull->faces[face].corners[k % count()])];
  }
  const Vec3& normal() const { return hull.normals[face]; }
  double offset() const { return hull.offsets[face]; }
};

// The upper shape comes first. The face or disc below looks along n. A cylinder touches with its side and its end.
void add_area(const CurvedSolid& upper, const FlatFace& lower, const AreaPoints& to);
void add_area(const CurvedSolid& upper, const Disc& lower, const AreaPoints& to);
void add_area(const Disc& upper, const FlatFace& lower, const AreaPoints& to);
void add_area(const Line& upper, const Disc& lower, const AreaPoints& to);

}  // namespace rigor::inline dynamics
