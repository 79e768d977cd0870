// A convex polyhedron: the hull of points, by Qhull (Barber, Dobkin, Huhdanpaa, The Quickhull algorithm for convex
// hulls, 1996). Coplanar triangles are joined to one face.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "core/scene/shapes/triangle_mesh.h"

namespace rigor::inline scene {

struct Hull {
  static constexpr std::size_t kMostPoints = 200'000;  // given
  static constexpr std::size_t kMostCorners = 2000;    // of the hull

  struct Face {
    Vec3 normal = Vec3::Zero();  // unit, outwards
    double offset = 0;           // m: normal · x <= offset for each point of the hull
    std::vector<int> corners;    // anticlockwise as seen from outside
    std::vector<int> edges;      // edges[i] leads from corners[i] to the next one
  };
  struct Edge {
    int from, to;     // corners
    int left, right;  // the faces in which it leads from `from` to `to`, and back
  };

  std::vector<Vec3> points;  // m: the corners
  std::vector<Face> faces;
  std::vector<Edge> edges;
  double volume = 0;            // m³
  Vec3 centre = Vec3::Zero();   // m: the centre of mass
  Mat3 inertia = Mat3::Zero();  // m⁵: about the centre, of unit density
  double bounding_radius = 0;   // m, about the origin
  double inradius = 0;          // m, from the centre to the nearest face
  double least_cosine = 1;      // between the normals of faces that share an edge

  std::size_t furthest(const Vec3& n) const;  // the corner with the largest n · x
  TriangleMesh drawn() const;
};

// Throws InputError, without a place: fewer than four points, points in one plane, numbers that are not finite, or too
// many points or corners.
std::shared_ptr<const Hull> hull_of(const std::vector<Vec3>& points);

// The hull with each point multiplied by `factor` > 0, or moved.
std::shared_ptr<const Hull> scaled_hull(const Hull& hull, double factor);
// The mirror image at the plane x = 0.
std::shared_ptr<const Hull> mirrored_hull(const Hull& hull);

}  // namespace rigor::inline scene
