// The row of a coupling (scene.h): x - ratio y - offset = 0, with up to four bodies at its ends. The angles of hinges
// are known up to whole turns, and with a ratio these count. One angle's turns follow from the other coordinate by the
// coupling itself, since its gap is small. This is exact, however fast they turn, where a slider is coupled to a hinge,
// and where the ratio or its inverse is a whole number. With another ratio of two hinges, the slower one may turn by
// less than half a turn between two evaluations. With several terms no angle makes a whole turn.
#pragma once

#include <array>
#include <vector>

#include "core/dynamics/model/joint_coordinate.h"

namespace rigor::inline dynamics {

class CoupledCoordinates {
 public:
  CoupledCoordinates(const Scene& scene, const Coupling& coupling);

  struct Row {
    std::array<Vec3, kMostCoupledEnds> force, torque;  // of a unit of effort on each of ends(), in W
    double gap, bias;
  };
  Row at(BodyColumns state);
  // The bodies at its ends, each once, or kWorld.
  const std::array<int, kMostCoupledEnds>& ends() const { return ends_; }
  int count() const { return count_; }
  bool turns() const { return terms_.front().coordinate.turns(); }

 private:
  // Of the sum that is to be the offset: x times 1, and the others times -ratio.
  struct Term {
    JointCoordinate coordinate;
    double factor;
    int place_a, place_b;     // among the ends
    double angle = 0, x = 0;  // rad, m: the coordinate, without and with its whole turns
  };
  void add(const Scene& scene, int joint, double factor);
  int end(int body);
  void count_turns();

  std::vector<Term> terms_;
  double offset_;
  bool turns_of_y_follow_ = false;  // from x; else those of x from y
  std::array<int, kMostCoupledEnds> ends_{kWorld, kWorld, kWorld, kWorld};
  int count_ = 0;
};

}  // namespace rigor::inline dynamics
