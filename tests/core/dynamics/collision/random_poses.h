// Seeded places and turns of shapes.
#pragma once

#include <random>

#include "core/base/math.h"

namespace rigor::test {

class RandomPoses {
 public:
  explicit RandomPoses(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3 vector(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  Mat3 turn() {
    return Quat(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)).normalized().toRotationMatrix();
  }

 private:
  std::mt19937 random_;
};

}  // namespace rigor::test
