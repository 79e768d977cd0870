// All joints of a scene together: the forces and impulses that keep them, and the way back to where they hold. With
// J the rows of all joints, M the bodies' masses and inertias, and S = J M⁻¹ Jᵀ the Delassus matrix (block_cholesky.h):
//   accelerations  M V' = f + Jᵀ l,  J V' = -J' V             hold()
//   velocities     J V = 0 by an impulse Jᵀ l                 velocity_impulse()
//   a drift        that ends where g = 0, by an impulse at its start along J there  (SHAKE and RATTLE)   close()
//   a state        moved by the least motion in the metric of M to g = 0 and J V = 0    project()
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/dynamics/joints/block_cholesky.h"
#include "core/dynamics/joints/joint_constraint.h"
#include "core/dynamics/model/constraint_forces.h"
#include "core/dynamics/model/system.h"
#include "core/engine/columns.h"

namespace rigor {

class Joints : public ConstraintForces {
 public:
  // The system must outlive it.
  Joints(const Scene& scene, const System& system);

  const double* hold(BodyColumns state, const double* wrench, Rows rows) override;

  // Wrench columns of the impulse [N s, N m s] after which J V = 0 at this pose. Valid until the next call.
  const double* velocity_impulse(BodyColumns state);
  void project(MutableBodyColumns state);

  // Finds the impulse at the pose `start` that closes all joints at the end of a drift of length h [s]. `attempt` takes
  // wrench columns of an impulse and returns where a drift with it ends; its last call is with the impulse found.
  void close(BodyColumns start, double h, const std::function<BodyColumns(const double* impulse)>& attempt);
  // Adds an impulse to v and w at the pose of the last factorisation.
  void push(const double* impulse, MutableBodyColumns state) const;

  // The largest |g| at a state [m, or sine of an angle].
  double gap(BodyColumns state) { return measure_gaps(state); }

  // Rows of all joints, and how many of them do not repeat others.
  int rows() const { return rows_total_; }
  int rank() const { return rank_total_; }

  // Why what was done since begin_step() is not what was asked; empty if it is.
  void begin_step() { warning_.clear(); }
  std::string warning() const { return contradiction_.empty() ? warning_ : contradiction_; }

 private:
  struct Held {  // a joint
    std::unique_ptr<JointConstraint> constraint;
    int rows = 0;
    int end[2] = {kWorld, kWorld};                   // the bodies at its ends
    int body[2] = {kWorld, kWorld};                  // of those the ones that can move, or kWorld
    Block6 J[2] = {Block6::Zero(), Block6::Zero()};  // one row a row; zero beyond rows
    Block6 Y[2] = {Block6::Zero(), Block6::Zero()};  // J M⁻¹
    Vec6 gap = Vec6::Zero(), bias = Vec6::Zero();    // zero beyond rows
  };
  struct Coupling {  // two joints on a body
    std::int32_t first, second;
    std::int8_t first_end, second_end;
    BlockCholesky::Place place;
  };
  struct Frame {  // of a body that some joint moves
    EndMotion motion;
    Mat3 inverse_inertia_W;  // 1/(kg m²)
  };

  void list_couplings();
  void find_ranks(BodyColumns state);
  void look_for_contradictions();
  void evaluate(BodyColumns state);              // frames, J, gaps and biases
  void assemble();                               // S
  void factorise(BodyColumns state, Rows rows);  // all of these, and the factor
  // The largest |g| at other poses; J stays.
  double measure_gaps(BodyColumns state);
  double largest_gap() const;
  template <typename RightSide>
  void solve_for(const RightSide& right_side);
  void refine();
  const double* as_wrench(const std::vector<Vec6>& multipliers);
  Vec6 free_acceleration(int body, const double* wrench) const;
  const double* impulse_against_velocities();
  void close_pose(MutableBodyColumns state);
  void move(const double* wrench, MutableBodyColumns state) const;
  bool is_closed(double gap, double last) const;
  void warn_of_gap(double gap);
  void warn_if_singular();

  const System& system_;
  std::vector<std::string> names_;
  std::vector<Held> joints_;
  std::vector<int> moved_;     // bodies
  std::vector<Frame> frames_;  // by body
  std::unique_ptr<BlockCholesky> factor_;
  std::vector<Coupling> couplings_;
  std::vector<Vec6> multipliers_, total_multipliers_, right_side_, correction_;  // by joint
  std::vector<Vec6> free_;  // by body: accelerations without joints
  Columns wrench_, total_;
  double extent_ = 1;  // m: the longest arm, what gaps are small against
  int rows_total_ = 0, rank_total_ = 0;
  std::string contradiction_, warning_;
};

}  // namespace rigor
