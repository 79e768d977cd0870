// The system of linear equations for the forces of one island's persistent contacts: of all multipliers l with
//   J (V' + M⁻¹ Pᵀ l) = -J'V,
// V' the accelerations without them, nearly the least, by rounds of
//   (J M⁻¹ Pᵀ + 1/rho) dl = -J'V - J V',
// each solved in forces or, if there are many rows, in the bodies' accelerations, six for each body. Units are the
// bodies' square roots of mass, so that M is 1. With joints each row gives M⁻¹ Pᵀ itself.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/base/factors.h"

namespace rigor::inline dynamics {

class ForceEquations {
 public:
  struct Side {
    int place = -1;  // of a moving body in the island, or -1
    Vec6 of_J = Vec6::Zero(), of_P = Vec6::Zero();
  };
  struct Row {
    std::size_t point = 0;
    int axis = 0;  // of the point's frame
    Side side[2];
    double bias = 0, weight = 0;  // m/s², kg
    double multiplier = 0;        // N
    Eigen::VectorXd response;     // of all bodies of the island to a unit of P, through joints; empty without
    double square() const { return side[0].of_J.squaredNorm() + side[1].of_J.squaredNorm(); }
  };

  explicit ForceEquations(bool is_through_joints) : is_through_joints_(is_through_joints) {}

  void clear();
  // Its square must not be zero; its weight is found here. The matrix is symmetric where every row's P is its J.
  void add(Row row, bool has_P_of_J);
  // Finds the multipliers. `free`: V', six a body.
  void solve(const Eigen::VectorXd& free);
  const std::vector<Row>& rows() const { return rows_; }
  // The accelerations of the last solve() with the forces, six a body.
  const Eigen::VectorXd& accelerations(const Eigen::VectorXd& free) {
    find_residuals(free);
    return acceleration_;
  }
  // The change of accelerations of `size`, six per body, by the forces.
  Eigen::VectorXd accelerations_through_joints(Eigen::Index size) const;

 private:
  double find_residuals(const Eigen::VectorXd& free);
  Eigen::VectorXd change_through_accelerations(Eigen::Index size) const;
  void assemble_in_accelerations(Eigen::Index size);
  void assemble_in_forces();
  double effect(const Row& of, const Row& by) const;

  bool is_through_joints_;
  std::vector<Row> rows_;
  bool is_symmetric_ = true;
  Eigen::MatrixXd matrix_;
  DenseFactors factors_;
  Eigen::VectorXd acceleration_, residual_;
};

}  // namespace rigor::inline dynamics
