// Random convex shapes of 2 cm to 1 m, thin and sharp ones among them: what a few shapes by hand do not find.
#pragma once

#include <cmath>
#include <vector>

#include "tests/core/dynamics/collision/random_poses.h"

namespace rigor::test {

class AnyShape {
 public:
  explicit AnyShape(RandomPoses& random) : random_(random) {}

  Shape operator()() {
    const double kind = random_.between(0, 1);
    if (kind < 0.3) return Cylinder{size(), 2 * size()};
    if (kind < 0.5) return Ellipsoid{sizes()};
    if (kind < 0.7) return Box{sizes()};
    if (kind < 0.8) return Capsule{size(), size()};
    std::vector<Vec3> corners;
    const Vec3 stretch = sizes();
    for (int k = 0; k < 12; ++k) corners.push_back(stretch.cwiseProduct(random_.vector(1)));
    return Convex{hull_of(corners)};
  }

 private:
  double size() { return std::exp(random_.between(std::log(0.02), 0)); }  // m
  Vec3 sizes() {
    const double x = size(), y = size();
    return {x, y, size()};
  }

  RandomPoses& random_;
};

}  // namespace rigor::test
