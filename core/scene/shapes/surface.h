// Triangles with solid ground behind them, for what stands still: a closed mesh, or a height field. Normals, the edges
// and corners that stick out, and a tree that finds the triangles near a box are made once.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/base/math.h"
#include "core/scene/shapes/triangle_mesh.h"

namespace rigor::inline scene {

struct TriangleSurface {
  static constexpr std::size_t kMostTriangles = 200'000;

  struct Triangle {
    std::array<int, 3> corners;  // anticlockwise as seen from outside
    std::array<int, 3> beside = {-1, -1,
                                 -1};  // across the edge from corners[k] to the next; -1: a height field's border
    Vec3 normal = Vec3::Zero();        // unit, outwards
    int patch = -1;                    // the number of the flat region to which it belongs
  };
  // An edge that sticks out. Flat and reentrant edges are never what a convex body touches alone.
  struct Ridge {
    int from, to;
    int left, right;             // the triangles on both sides
    Vec3 into_left, into_right;  // unit, along the two triangles, away from the edge
  };
  // A corner at which a ridge begins or ends.
  struct Peak {
    int point;
    std::vector<Vec3> edges;  // unit, along all edges that leave it
  };

  std::vector<Vec3> points;  // m
  std::vector<Triangle> triangles;
  std::vector<Ridge> ridges;
  std::vector<Peak> peaks;
  double volume = 0;            // m³, of a closed mesh; else 0
  Vec3 centre = Vec3::Zero();   // m, of that volume
  Mat3 inertia = Mat3::Zero();  // m⁵, about the centre, of unit density
  double bounding_radius = 0;   // m, about the origin
  Vec3 low, high;               // m, the box around all points

  // By triangle: the ridges and peaks that are looked at with it, each with one of its triangles.
  std::vector<std::vector<int>> ridges_of, peaks_of;

  // The triangles whose boxes overlap this box.
  void find_near(const Vec3& box_low, const Vec3& box_high, std::vector<int>& out) const;
  // The nearest point to p. What is farther than `most` [m] may be missed: then the point is infinitely far.
  Vec3 nearest(const Vec3& p, double most) const;
  // The nearest point to p of one triangle.
  Vec3 nearest_on(const Triangle& triangle, const Vec3& p) const;
  TriangleMesh drawn() const;
  void scale(double factor);

 private:
  friend class SurfaceBuilder;
  // A binary tree over the triangles in `order`; a leaf has `count` of them from `first` on.
  struct Node {
    Vec3 low, high;
    int first, count, right;  // the left child follows its parent
  };
  // Calls visit(number of a triangle) for those in nodes that `enters` lets in, the left child first if `left_is_first`
  // says so.
  template <typename Enters, typename LeftIsFirst, typename Visit>
  void descend(const Enters& enters, const LeftIsFirst& left_is_first, const Visit& visit) const;

  std::vector<Node> nodes;
  std::vector<int> order;
};

using Corners = std::array<int, 3>;

// A mesh encloses a volume. Points at the same place are one. Throws InputError, without a place:
//   numbers that are not finite, corners that no point has, too many triangles, triangles without an area;
//   an open or flat mesh, an edge that not exactly two triangles share;
//   triangles that look inwards, triangles that cut each other.
std::shared_ptr<const TriangleSurface> closed_surface(const std::vector<Vec3>& points,
                                                      const std::vector<Corners>& triangles);

std::shared_ptr<const TriangleSurface> closed_surface(const TriangleMesh& drawn);

// Heights [m] above a rectangle of size.x by size.y [m] about the origin, by rows along y, each along x. Each cell is
// divided by the diagonal from its corner at low x and low y. Throws InputError as above.
std::shared_ptr<const TriangleSurface> height_surface(const std::array<double, 2>& size,
                                                      const std::vector<std::vector<double>>& heights);

std::shared_ptr<const TriangleSurface> scaled_surface(const TriangleSurface& surface, double factor);  // factor > 0

}  // namespace rigor::inline scene
