#pragma once

#include "core/scene/shapes/shape_descriptor.h"

namespace rigor::inline scene {

struct Ellipsoid {
  Vec3 radii;  // m, the half-axes along x, y and z

  static constexpr ShapeDescriptor<Ellipsoid> descriptor() {
    return {"ellipsoid", "An ellipsoid by its half-axes.", {{{"radii", ShapeQuantity::lengths, &Ellipsoid::radii}}}};
  }

  double volume() const { return 4 * kPi / 3 * radii.prod(); }
  Vec3 centre() const { return Vec3::Zero(); }
  Mat3 inertia(double mass) const {
    const Vec3 s = radii.cwiseAbs2();
    return mass / 5 * diagonal_inertia(s.y() + s.z(), s.x() + s.z(), s.x() + s.y());
  }
  double bounding_radius() const { return radii.maxCoeff(); }
  double inradius() const { return radii.minCoeff(); }
  Vec3 support(const Vec3& n) const {
    const Vec3 stretched = radii.cwiseProduct(n);
    return radii.cwiseProduct(stretched) / stretched.norm();
  }
  TriangleMesh drawn() const { return scaled(unit_ball(), 2 * radii); }
};

}  // namespace rigor::inline scene
