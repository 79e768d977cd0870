// The least motion of the bodies, weighed by mass, that changes given speeds or distances at points by given amounts:
// that by which pushes at those points would move them. It closes gaps, and takes away what is left of a speed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/dynamics/model/system.h"

namespace rigor {

struct Demand {
  int a = 0, b = 0;       // bodies
  Vec3 arm_a, arm_b;      // m, to the point, in W
  Vec3 direction;         // unit, in W, of a against b
  double amount = 0;      // m or m/s, of the motion of a against b along it
  bool both_ways = true;  // false: b may push a along the direction, but not pull it
};

// Three of a body's speeds along and three about W's axes, or what these make of its pose.
using PoseStep = Eigen::Matrix<double, 6, 1>;

class LeastMotion {
 public:
  explicit LeastMotion(const System& system) : system_(system) {}
  // One step for each body of the system; none for any where that is impossible, and a solver warning.
  const std::vector<PoseStep>& meet(BodyColumns state, const std::vector<Demand>& demands);
  // Of all since the last call.
  std::string take_solver_warning() { return std::exchange(solver_warning_, {}); }

 private:
  struct Side {
    int body;
    PoseStep by, to;  // of the amount, by the body's motion; of the motion, by a push
  };
  Side side_of(BodyColumns state, int body, const Vec3& arm, const Vec3& direction) const;
  Eigen::VectorXd pushes(const std::vector<Demand>& demands, const std::vector<bool>& is_used);

  const System& system_;
  std::vector<std::array<Side, 2>> sides_;
  std::vector<PoseStep> motion_;
  std::string solver_warning_;
};

}  // namespace rigor
