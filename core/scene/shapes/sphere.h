#pragma once

#include "core/scene/shapes/shape_descriptor.h"

namespace rigor::inline scene {

struct Sphere {
  double radius;  // m

  static constexpr ShapeDescriptor<Sphere> descriptor() {
    return {"sphere", "A ball.", {{{"radius", ShapeQuantity::length, &Sphere::radius}}}};
  }

  double volume() const { return 4 * kPi / 3 * radius * radius * radius; }
  Vec3 centre() const { return Vec3::Zero(); }
  Mat3 inertia(double mass) const {
    const double i = 0.4 * mass * radius * radius;
    return diagonal_inertia(i, i, i);
  }
  double bounding_radius() const { return radius; }
  double inradius() const { return radius; }
  Vec3 support(const Vec3& n) const { return radius * n.normalized(); }
  TriangleMesh drawn() const { return scaled(unit_ball(), Vec3::Constant(2 * radius)); }
};

}  // namespace rigor::inline scene
