// Joints of Bullet 3.24 with its direct solver (MLCP, Dantzig), for its twin: Bullet's own rows (bullet_twin_rows.h),
// and the common solution of all direct solvers (twin_joint_solver.h). Sequential impulses are Gauss-Seidel sweeps over
// the same rows. They end before convergence where joints form a chain, and are not repeated.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/bullet/bullet_twin_rows.h"
#include "adapters/common/twin_joint_solver.h"

namespace rigor::inline adapters {

class BulletTwinJoints {
 public:
  // No cfm: the matched track's. The system must outlive it.
  BulletTwinJoints(const Scene& scene, const System& system, double erp, std::optional<double> cfm);

  // Changes the velocities of a state whose poses are those of the step's start.
  void push(MutableBodyColumns state, double dt);
  std::string warning() const { return solver_.warning(); }  // of the last push

 private:
  struct JointWithRows {
    std::unique_ptr<BulletJointRows> rows;
    int a, b;  // bodies that move, or kWorld
  };

  const System& system_;
  TwinJointSolver solver_;
  std::vector<JointWithRows> joints_;
  std::vector<ConstraintRow> found_;
};

}  // namespace rigor::inline adapters
