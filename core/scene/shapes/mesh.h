#pragma once

#include <memory>

#include "core/scene/shapes/shape_descriptor.h"
#include "core/scene/shapes/surface.h"

namespace rigor::inline scene {

// What a mesh and a height field have in common. Copies share the surface. Its body is fixed, and stands alone.
struct SurfaceShape {
  std::shared_ptr<const TriangleSurface> surface;

  double volume() const { return surface->volume; }
  Vec3 centre() const { return surface->centre; }
  Mat3 inertia(double mass) const { return mass / surface->volume * surface->inertia; }
  double bounding_radius() const { return surface->bounding_radius; }
  double inradius() const { return surface->bounding_radius; }  // a moving body has the smaller one
  Vec3 support(const Vec3& n) const;                            // of its convex hull
  TriangleMesh drawn() const { return surface->drawn(); }
};

struct Mesh : SurfaceShape {
  // Its triangles are read and written apart: mesh{points, triangles} or mesh{file, scale}.
  static constexpr ShapeDescriptor<Mesh> descriptor() {
    return {"mesh", "Triangles around the volume of a fixed body."};
  }
};

}  // namespace rigor::inline scene
