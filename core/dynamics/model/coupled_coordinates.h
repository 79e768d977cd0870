// The row of a coupling (scene.h): x - ratio y - offset = 0, with up to four bodies at its ends. The coordinates of
// hinges are known up to whole turns, and with a ratio these count. They are those nearest to the last evaluation.
#pragma once

#include <array>

#include "core/dynamics/model/joint_coordinate.h"

namespace rigor {

class CoupledCoordinates {
 public:
  CoupledCoordinates(const Scene& scene, const Coupling& coupling);

  struct Row {
    std::array<Vec3, 4> force, torque;  // of a unit of effort on each of ends(), in W
    double gap, bias;
  };
  Row at(BodyColumns state);
  // The bodies at its ends, each once, or kWorld.
  const std::array<int, 4>& ends() const { return ends_; }
  int count() const { return count_; }
  bool turns() const { return x_.turns(); }

 private:
  int end(int body);

  JointCoordinate x_, y_;
  double ratio_, offset_;
  double last_x_ = 0, last_y_ = 0;  // rad, m
  std::array<int, 4> ends_{kWorld, kWorld, kWorld, kWorld};
  int count_ = 0;
  int place_[4];  // among the ends: of x's a and b, and of y's
};

}  // namespace rigor
