#pragma once

#include <algorithm>
#include <cmath>

#include "core/scene/shapes/shape_descriptor.h"

namespace rigor::inline scene {

struct Cylinder {
  double radius;  // m
  double length;  // m, along z

  static constexpr ShapeDescriptor<Cylinder> descriptor() {
    return {
        "cylinder",
        "A cylinder along z with flat ends.",
        {{{"radius", ShapeQuantity::length, &Cylinder::radius}, {"length", ShapeQuantity::length, &Cylinder::length}}}};
  }

  double volume() const { return kPi * radius * radius * length; }
  Vec3 centre() const { return Vec3::Zero(); }
  Mat3 inertia(double mass) const {
    const double across = mass * (radius * radius / 4 + length * length / 12);
    return diagonal_inertia(across, across, 0.5 * mass * radius * radius);
  }
  double bounding_radius() const { return std::hypot(radius, 0.5 * length); }
  double inradius() const { return std::min(radius, 0.5 * length); }
  Vec3 support(const Vec3& n) const {
    const double across = std::hypot(n.x(), n.y()), scale = across > 0 ? radius / across : 0;
    return {scale * n.x(), scale * n.y(), (n.z() < 0 ? -0.5 : 0.5) * length};
  }
  TriangleMesh drawn() const {
    const double h = 0.5 * length;
    return rings(
        {{0, -h, 0, -1}, {radius, -h, 0, -1}, {radius, -h, 1, 0}, {radius, h, 1, 0}, {radius, h, 0, 1}, {0, h, 0, 1}});
  }
};

}  // namespace rigor::inline scene
