// Joints as worldstep of ODE 0.16 holds them, for its twin. With J the rows of all joints, e what is missing along each
// (m, rad), v the velocities that the loads have made of the step's, M and J at the step's start:
//   (J M⁻¹ Jᵀ + cfm/dt) p = erp/dt e - J v,   v <- v + M⁻¹ Jᵀ p
// so that a share erp of each gap is closed in a step, by a speed that stays. Without limits there is nothing to choose
// and ODE's Dantzig solver comes to the same as any factorisation. Rows as its manual derives them ("Joint error and
// the error reduction parameter", "Constraint equations"), told from its motion.
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/dynamics/joints/constraint_rows.h"
#include "core/dynamics/model/system.h"
#include "core/engine/columns.h"

namespace rigor {

// Where one end of a joint is; the world, and a body that stays, at W itself.
struct OdeEnd {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Mat3 R = Mat3::Identity();
  bool moves = false;
};

struct OdeRows {
  using Block = Eigen::Matrix<double, kMostRows, 6>;
  Block on_first = Block::Zero(), on_second = Block::Zero();  // of (v, w)
  Vec6 missing = Vec6::Zero();                                // m, rad
};

class OdeJointRows {
 public:
  virtual ~OdeJointRows() = default;
  virtual int count() const = 0;
  virtual void fill(const OdeEnd& first, const OdeEnd& second, OdeRows& rows) const = 0;  // rows are zero before
};

class OdeTwinJoints {
 public:
  // No cfm: the matched track's. The system must outlive it.
  OdeTwinJoints(const Scene& scene, const System& system, double erp, std::optional<double> cfm);

  // Pushes the velocities of a state whose poses are those of the step's start.
  void push(MutableBodyColumns state, double dt);
  std::string warning() const { return warning_; }  // of the last push

 private:
  using Sparse = Eigen::SparseMatrix<double>;
  struct Held {
    std::unique_ptr<OdeJointRows> rows;
    int first, second;  // bodies; the second kWorld where it stays
  };

  OdeEnd end_of(BodyColumns state, int body) const;
  void assemble(BodyColumns state);  // J, what is missing, M⁻¹

  const System& system_;
  double erp_;
  std::optional<double> cfm_;
  double softness_;  // 1/kg
  std::vector<Held> joints_;
  Eigen::Index row_count_ = 0;
  Sparse J_, inverse_mass_;  // columns: (v, w) of each body
  Eigen::VectorXd missing_, velocities_;
  Eigen::SimplicialLDLT<Sparse> factor_;
  std::string warning_;
};

}  // namespace rigor
