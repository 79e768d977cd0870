// The row of a coupling (scene.h): x - ratio y - offset = 0, with up to four bodies at its ends. The angles of hinges
// are known up to whole turns, and with a ratio these count. One angle's turns follow from the other coordinate by the
// coupling itself, since its gap is small. This is exact, however fast they turn, where a slider is coupled to a hinge,
// and where the ratio or its inverse is a whole number. With another ratio of two hinges, the slower one may turn by
// less than half a turn between two evaluations.
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
  void count_turns(double x, double y);

  JointCoordinate x_, y_;
  double ratio_, offset_;
  bool turns_of_y_follow_;          // from x; else those of x from y
  double last_x_ = 0, last_y_ = 0;  // rad, m
  std::array<int, 4> ends_{kWorld, kWorld, kWorld, kWorld};
  int count_ = 0;
  int place_[4];  // among the ends: of x's a and b, and of y's
};

}  // namespace rigor
