#pragma once

#include "core/scene/shapes/shape_descriptor.h"

namespace rigor::inline scene {

struct Capsule {
  double radius;  // m
  double length;  // m, of the cylinder between the two half-spheres, along z

  static constexpr ShapeDescriptor<Capsule> descriptor() {
    return {
        "capsule",
        "A cylinder along z with a half-sphere on each end; the length is that of the cylinder.",
        {{{"radius", ShapeQuantity::length, &Capsule::radius}, {"length", ShapeQuantity::length, &Capsule::length}}}};
  }

  double volume() const { return (4.0 / 3 * radius + length) * kPi * radius * radius; }
  Vec3 centre() const { return Vec3::Zero(); }
  // A cylinder and two half-spheres. A half-sphere's centre of mass lies 3/8 r from its flat face, and its inertia
  // about a diameter of that face is 2/5 m r².
  Mat3 inertia(double mass) const {
    const double r = radius, h = length;
    const double cylinder_volume = kPi * r * r * h, ball_volume = 4.0 / 3.0 * kPi * r * r * r;
    const double mc = mass * cylinder_volume / (cylinder_volume + ball_volume), mb = mass - mc;
    const double axial = 0.5 * mc * r * r + 0.4 * mb * r * r;
    const double across = mc * (h * h / 12.0 + r * r / 4.0) + mb * (0.4 * r * r + h * h / 4.0 + 3.0 / 8.0 * h * r);
    return diagonal_inertia(across, across, axial);
  }
  double bounding_radius() const { return radius + 0.5 * length; }
  double inradius() const { return radius; }
  Vec3 support(const Vec3& n) const {
    return radius * n.normalized() + (n.z() < 0 ? -0.5 : 0.5) * length * Vec3::UnitZ();
  }
  TriangleMesh drawn() const {
    TriangleMesh mesh = scaled(unit_tube(), {2 * radius, 2 * radius, length});
    for (const double side : {-0.5, 0.5})
      append(mesh, scaled(unit_ball(), Vec3::Constant(2 * radius)), side * length * Vec3::UnitZ());
    return mesh;
  }
};

}  // namespace rigor::inline scene
