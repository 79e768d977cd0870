// A convex hull in the arrays that ODE wants, and that it keeps pointers to.
#pragma once

#include <ode/ode.h>

#include <vector>

#include "core/scene/shapes/hull.h"

namespace rigor {

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

}  // namespace rigor
