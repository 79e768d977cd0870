// The mass-weighted least-norm projection onto constraints at points: of all motions dx of the bodies with J dx = b,
// the one of least dx·M dx,
//   dx = M⁻¹ Jᵀ lambda,   (J M⁻¹ Jᵀ) lambda = b,
// with J M⁻¹ Jᵀ the Delassus matrix; unilateral targets keep lambda >= 0. It closes gaps, and removes residual speeds.
// With joints M⁻¹ is replaced by its part that they allow (impulse_responses.h), so no motion violates them to first
// order.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/factors.h"
#include "core/dynamics/contact/event/cone_solver.h"

namespace rigor::inline dynamics {

struct ProjectionTarget {
  int a = 0, b = 0;            // bodies, or the world
  Vec3 arm_a, arm_b;           // m, to the point, in W
  Vec3 direction;              // unit, in W, of a against b
  bool is_of_turning = false;  // a's rotation against b's about the direction, not a motion of the point along it
  double amount = 0;           // b: m or m/s, rad or rad/s, of the motion of a against b
  bool bilateral = true;       // false: unilateral, b may push a along the direction but not pull it
};

// Along an axis of the cone's frame.
ProjectionTarget target_of(const ConeConstraint& cone, int axis, double amount, bool bilateral);

// Three of a body's speeds along and three about W's axes, or the change of its pose by these.
using PoseStep = Eigen::Matrix<double, 6, 1>;

class MassWeightedProjection {
 public:
  // `joints`, which may be null, must outlive it.
  explicit MassWeightedProjection(const System& system, Joints* joints = nullptr) : system_(system), joints_(joints) {
    if (joints_) through_joints_.emplace(system, *joints_);
  }
  // One step for each body of the system; none for any where that is impossible, and a solver warning.
  const std::vector<PoseStep>& project(BodyColumns state, const std::vector<ProjectionTarget>& targets);
  // The warnings since the last call of this function.
  std::string take_solver_warning() { return std::exchange(solver_warning_, {}); }

 private:
  struct Part {
    int body;
    PoseStep of;
  };
  struct Row {
    std::vector<Part> by, to;  // the row of J; the column of M⁻¹ Jᵀ
    double scale = 0;          // by M⁻¹ byᵀ, without joints
  };
  Row row_of(BodyColumns state, const ProjectionTarget& target);
  Eigen::VectorXd multipliers(const std::vector<ProjectionTarget>& targets, const std::vector<bool>& is_used);

  const System& system_;
  Joints* joints_;
  std::optional<ImpulseResponses> through_joints_;
  std::vector<Row> rows_;
  DenseFactors dense_;
  std::vector<PoseStep> motion_;
  std::string solver_warning_;
};

}  // namespace rigor::inline dynamics
