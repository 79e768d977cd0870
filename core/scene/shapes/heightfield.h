#pragma once

#include <array>
#include <vector>

#include "core/scene/shapes/mesh.h"

namespace rigor::inline scene {

// Ground of a fixed body, solid down to any depth. Beyond its border there is nothing.
struct Heightfield : SurfaceShape {
  std::array<double, 2> size = {};           // m, along x and y, about the origin
  std::vector<std::vector<double>> heights;  // m, by rows along y, each along x

  // Both are read and written apart.
  static constexpr ShapeDescriptor<Heightfield> descriptor() {
    return {"heightfield", "Heights of the ground above a rectangle, of a fixed body."};
  }
};

}  // namespace rigor::inline scene
