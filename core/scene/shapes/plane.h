#pragma once

#include "core/scene/shapes/shape_descriptor.h"

namespace rigor::inline scene {

// Given in W, wherever its body is.
struct Plane {
  Vec3 normal;    // unit, in W; the solid half-space lies behind it
  double offset;  // m; the plane is normal · x = offset

  static constexpr ShapeDescriptor<Plane> descriptor() {
    return {
        "plane",
        "The solid half-space normal · x <= offset of a fixed body, given in W.",
        {{{"normal", ShapeQuantity::direction, &Plane::normal}, {"offset", ShapeQuantity::number, &Plane::offset}}}};
  }

  double volume() const { return 0; }
  Vec3 centre() const { return Vec3::Zero(); }
  Mat3 inertia(double) const { return Mat3::Zero(); }
  double bounding_radius() const { return kEndless; }
  double inradius() const { return kEndless; }
  Vec3 support(const Vec3& n) const { return kEndless * n; }
  TriangleMesh drawn() const { return {}; }
};

}  // namespace rigor::inline scene
