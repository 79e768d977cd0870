#pragma once

#include <memory>

#include "core/scene/shapes/hull.h"
#include "core/scene/shapes/shape_descriptor.h"

namespace rigor::inline scene {

// The convex hull of points. Copies share it.
struct Convex {
  std::shared_ptr<const Hull> hull;

  // Its points are read and written apart: convex{points} or convex{file, scale}.
  static constexpr ShapeDescriptor<Convex> descriptor() { return {"convex", "The convex hull of points."}; }

  double volume() const { return hull->volume; }
  Vec3 centre() const { return hull->centre; }
  Mat3 inertia(double mass) const { return mass / hull->volume * hull->inertia; }
  double bounding_radius() const { return hull->bounding_radius; }
  double inradius() const { return hull->inradius; }
  Vec3 support(const Vec3& n) const { return hull->points[hull->furthest(n)]; }
  TriangleMesh drawn() const { return hull->drawn(); }
};

}  // namespace rigor::inline scene
