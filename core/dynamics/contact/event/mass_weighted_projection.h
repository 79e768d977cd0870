// The mass-weighted least-norm projection onto constraints at points: of all motions dx of the bodies with J dx = b,
// the one of least dx·M dx,
//   dx = M⁻¹ Jᵀ lambda,   (J M⁻¹ Jᵀ) lambda = b,
// with J M⁻¹ Jᵀ the Delassus matrix; unilateral targets keep lambda >= 0. It closes gaps, and takes away what is left
// of a speed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/dynamics/model/system.h"

namespace rigor {

struct ProjectionTarget {
  int a = 0, b = 0;       // bodies
  Vec3 arm_a, arm_b;      // m, to the point, in W
  Vec3 direction;         // unit, in W, of a against b
  double amount = 0;      // b: m or m/s, of the motion of a against b along it
  bool bilateral = true;  // false: unilateral, b may push a along the direction but not pull it
};

// Three of a body's speeds along and three about W's axes, or what these make of its pose.
using PoseStep = Eigen::Matrix<double, 6, 1>;

class MassWeightedProjection {
 public:
  explicit MassWeightedProjection(const System& system) : system_(system) {}
  // One step for each body of the system; none for any where that is impossible, and a solver warning.
  const std::vector<PoseStep>& project(BodyColumns state, const std::vector<ProjectionTarget>& targets);
  // Of all since the last call.
  std::string take_solver_warning() { return std::exchange(solver_warning_, {}); }

 private:
  struct Side {
    int body;
    PoseStep by, to;  // the row of J; the column of M⁻¹ Jᵀ
  };
  Side side_of(BodyColumns state, int body, const Vec3& arm, const Vec3& direction) const;
  Eigen::VectorXd multipliers(const std::vector<ProjectionTarget>& targets, const std::vector<bool>& is_used);

  const System& system_;
  std::vector<std::array<Side, 2>> sides_;
  std::vector<PoseStep> motion_;
  std::string solver_warning_;
};

}  // namespace rigor
