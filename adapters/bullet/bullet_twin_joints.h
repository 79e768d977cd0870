// Joints as Bullet 3.24 with its direct solver (MLCP, Dantzig) holds them, for its twin. With J the rows of all joints
// as Bullet's constraints write them, g what is open along each (m, rad), v the velocities that loads and the
// gyroscopic term have made of the step's, M and J at the step's start:
//   (J M⁻¹ Jᵀ + cfm/dt) p = -erp/dt g - J v,   v <- v + M⁻¹ Jᵀ p
// so that a share erp of each gap is closed in a step, by a speed that stays. Where nothing is one-sided there is
// nothing to choose, and Dantzig's pivoting comes to the same as any factorisation. Sequential impulses are sweeps of
// Gauss and Seidel over the same rows, which end before they converge where joints hang in a row: not repeated.
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/bullet/bullet_twin_rows.h"
#include "core/dynamics/model/system.h"

namespace rigor {

class BulletTwinJoints {
 public:
  // No cfm: the matched track's. The system must outlive it.
  BulletTwinJoints(const Scene& scene, const System& system, double erp, std::optional<double> cfm);

  // Changes the velocities of a state whose poses are those of the step's start.
  void push(MutableBodyColumns state, double dt);
  std::string warning() const { return warning_; }  // of the last push

 private:
  using Sparse = Eigen::SparseMatrix<double>;
  struct Held {
    std::unique_ptr<BulletJointRows> rows;
    int a, b;  // bodies that move, or kWorld
  };

  void assemble(BodyColumns state);  // J, g, M⁻¹
  void enter(Eigen::Index row, int body, const Vec6& share);

  const System& system_;
  double erp_;
  std::optional<double> cfm_;
  double softness_;  // 1/kg
  std::vector<Held> joints_;
  std::vector<ConstraintRow> found_;
  std::vector<Eigen::Triplet<double>> of_J_, of_inverse_mass_;
  std::vector<double> gaps_;
  Sparse J_, inverse_mass_;  // columns: (v, w) of each body
  std::string warning_;
};

}  // namespace rigor
