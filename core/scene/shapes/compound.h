#pragma once

#include <vector>

#include "core/scene/shapes/shape_descriptor.h"

namespace rigor::inline scene {

struct PlacedShape;

// Several shapes of a body, or one that is not centred, each with its pose in B. Where shapes overlap, that volume
// counts for each of them. A compound has no compound or plane among its parts.
struct Compound {
  std::vector<PlacedShape> parts;

  // Case files write the parts: shapes = [{…}, {…}].
  static constexpr ShapeDescriptor<Compound> descriptor() { return {"compound", "Shapes with poses in B."}; }

  double volume() const;
  Vec3 centre() const;
  Mat3 inertia(double mass) const;
  double bounding_radius() const;
  double inradius() const;
  Vec3 support(const Vec3& n) const;
  TriangleMesh drawn() const;
};

}  // namespace rigor::inline scene
