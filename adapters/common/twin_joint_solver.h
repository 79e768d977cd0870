// The impulses of joints as the direct solvers of ODE 0.16 (worldstep) and Bullet 3.24 (MLCP) find them, for their
// twins. With J the rows of all joints as the engine writes them, e what is missing along each (m, rad), v the
// velocities that loads and the gyroscopic term have made of the step's, M and J at the step's start:
//   (J M⁻¹ Jᵀ + cfm/dt) p = erp/dt e - J v,   v <- v + M⁻¹ Jᵀ p
// so that a share erp of each gap is closed in a step, by a speed that stays. Without limits nothing is one-sided:
// there is nothing to choose, and Dantzig's pivoting comes to the same as any factorisation.
#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <string>
#include <vector>

#include "core/dynamics/joints/constraint_rows.h"
#include "core/dynamics/model/system.h"
#include "core/engine/columns.h"

namespace rigor {

class TwinJointSolver {
 public:
  // Without a cfm its `softness` [1/kg] takes the place of cfm/dt. The system must outlive it.
  TwinJointSolver(const System& system, double erp, std::optional<double> cfm, double softness)
      : system_(system), erp_(erp), cfm_(cfm), softness_(softness) {}

  // A row's parts on the (v, w) of its bodies, each an index or kWorld, and what is missing along it.
  void add_row(int a, const Vec6& on_a, int b, const Vec6& on_b, double missing);
  // Changes the velocities of a state whose poses are those of the step's start, and forgets the rows.
  void push(MutableBodyColumns state, double dt);
  std::string warning() const { return warning_; }  // of the last push

 private:
  using Sparse = Eigen::SparseMatrix<double>;
  void enter(int body, const Vec6& share);
  Sparse inverse_mass(BodyColumns state);
  template <typename Factors, typename Matrix>
  Eigen::VectorXd solved(const Factors& factors, const Matrix& matrix, const Eigen::VectorXd& right);

  const System& system_;
  double erp_;
  std::optional<double> cfm_;
  double softness_;  // 1/kg
  std::vector<Eigen::Triplet<double>> of_J_, of_inverse_mass_;
  std::vector<double> missing_;
  std::string warning_;
};

}  // namespace rigor
