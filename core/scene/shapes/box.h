#pragma once

#include "core/scene/shapes/shape_descriptor.h"

namespace rigor::inline scene {

struct Box {
  Vec3 size;  // m, full edge lengths

  static constexpr ShapeDescriptor<Box> descriptor() {
    return {"box", "A cuboid by its full edge lengths.", {{{"size", ShapeQuantity::lengths, &Box::size}}}};
  }

  double volume() const { return size.prod(); }
  Vec3 centre() const { return Vec3::Zero(); }
  Mat3 inertia(double mass) const {
    const Vec3 s = size.cwiseAbs2();
    return mass / 12.0 * diagonal_inertia(s.y() + s.z(), s.x() + s.z(), s.x() + s.y());
  }
  double bounding_radius() const { return 0.5 * size.norm(); }
  double inradius() const { return 0.5 * size.minCoeff(); }
  Vec3 support(const Vec3& n) const { return 0.5 * (n.array() < 0).select(-size.array(), size.array()).matrix(); }
  TriangleMesh drawn() const { return scaled(unit_cube(), size); }
};

}  // namespace rigor::inline scene
