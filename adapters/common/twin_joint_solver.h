// The joint impulses of the direct solvers of ODE 0.16 (worldstep) and Bullet 3.24 (MLCP), for their twins. J holds the
// rows of all joints in the engine's form, e their errors (m, rad), v the velocities after the step's loads and
// gyroscopic term; M and J are those of the step's start:
//   (J M⁻¹ Jᵀ + cfm/dt) p = erp/dt e - J v,   v <- v + M⁻¹ Jᵀ p
// A share erp of each gap is thus closed in a step, by a speed that stays. Without limits no row is one-sided, and
// Dantzig's pivoting gives the same result as any factorisation.
#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <string>
#include <vector>

#include "core/dynamics/joints/constraint_rows.h"
#include "core/dynamics/model/system.h"
#include "core/engine/columns.h"

namespace rigor::inline adapters {

class TwinJointSolver {
 public:
  // Without a cfm its `softness` [1/kg] takes the place of cfm/dt. The system must outlive it.
  TwinJointSolver(const System& system, double erp, std::optional<double> cfm, double softness)
      : system_(system), erp_(erp), cfm_(cfm), softness_(softness) {}

  // A row's parts on the (v, w) of its bodies, each an index or kWorld, and its error.
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

}  // namespace rigor::inline adapters
