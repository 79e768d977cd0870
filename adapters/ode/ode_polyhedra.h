// Hulls and triangles in the arrays that ODE wants, and that it keeps pointers to.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <vector>

#include "core/scene/shapes/hull.h"
#include "core/scene/shapes/surface.h"

namespace rigor::inline adapters {

class OdeHull {
 public:
  explicit OdeHull(const Hull& hull) {
    for (const Hull::Face& face : hull.faces) {
      planes_.insert(planes_.end(), {face.normal.x(), face.normal.y(), face.normal.z(), face.offset});
      polygons_.push_back(static_cast<unsigned>(face.corners.size()));
      for (const int corner : face.corners) polygons_.push_back(static_cast<unsigned>(corner));
    }
    for (const Vec3& point : hull.points) points_.insert(points_.end(), {point.x(), point.y(), point.z()});
  }

  dGeomID add_to(dSpaceID space) const {
    return dCreateConvex(space, planes_.data(), static_cast<unsigned>(planes_.size() / 4), points_.data(),
                         static_cast<unsigned>(points_.size() / 3), polygons_.data());
  }

 private:
  std::vector<dReal> planes_, points_;  // normal and offset; coordinates
  std::vector<unsigned> polygons_;      // of each face the number of its corners, and these, anticlockwise
};

// The triangles of a surface. ODE computes in double precision, but its tree of triangles in single.
class OdeTriangles {
 public:
  explicit OdeTriangles(const TriangleSurface& surface) : data_(dGeomTriMeshDataCreate()) {
    for (const Vec3& point : surface.points) points_.insert(points_.end(), {point.x(), point.y(), point.z()});
    for (const TriangleSurface::Triangle& triangle : surface.triangles)
      for (const int corner : triangle.corners) corners_.push_back(static_cast<dTriIndex>(corner));
    dGeomTriMeshDataBuildDouble(data_, points_.data(), 3 * sizeof(double), static_cast<int>(points_.size() / 3),
                                corners_.data(), static_cast<int>(corners_.size()), 3 * sizeof(dTriIndex));
  }
  ~OdeTriangles() { dGeomTriMeshDataDestroy(data_); }
  OdeTriangles(const OdeTriangles&) = delete;
  OdeTriangles& operator=(const OdeTriangles&) = delete;

  dGeomID add_to(dSpaceID space) const { return dCreateTriMesh(space, data_, nullptr, nullptr, nullptr); }

 private:
  dTriMeshDataID data_;
  std::vector<double> points_;
  std::vector<dTriIndex> corners_;
};

// They live as long as the geometries.
struct OdePolyhedra {
  std::vector<std::unique_ptr<OdeHull>> hulls;
  std::vector<std::unique_ptr<OdeTriangles>> surfaces;
};

}  // namespace rigor::inline adapters
