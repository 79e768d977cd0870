// All joints of a scene together: the forces and impulses that keep them, and the way back to where they hold. With
// J the rows of all joints, M the bodies' masses and inertias, and S = J M⁻¹ Jᵀ the Delassus matrix (block_cholesky.h):
//   accelerations  M V' = f + Jᵀ l,  J V' = -J' V             hold()
//   velocities     J V = 0 by an impulse Jᵀ l                 velocity_impulse()
//   a drift        that ends where g = 0, by an impulse at its start along J there  (SHAKE and RATTLE)   close()
//   a state        projected, with the least norm in the metric of M, to g = 0 and J V = 0    project()
// Coordinates that are kept or driven (joint_rows.h) have rows in all of these. Their owner decides which are active
// (joint_stops.h).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/dynamics/joints/joint_rows.h"
#include "core/dynamics/model/constraint_forces.h"

namespace rigor::inline engine {
class StateArchive;
}

namespace rigor::inline dynamics {

class Joints : public ConstraintForces {
 public:
  // The system must outlive it.
  Joints(const Scene& scene, const System& system);

  const double* hold(BodyColumns state, const double* wrench, Rows rows) override;

  // Wrench columns of the impulse [N s, N m s] after which J V = 0 at this pose. Valid until the next call. Rotors
  // have the speeds of their coordinates in `state`,
  const double* velocity_impulse(BodyColumns state);
  // or those that note_rotors() and the drifts since then gave them.
  const double* velocity_impulse_with_rotors(BodyColumns state);
  // Before a step of kicks and drifts changes velocities, notes the speed of each rotor (joint_rows.h), which no kick
  // acts on. `stagger` [s]: how long before the pose of `state` its velocities belong.
  void note_rotors(BodyColumns state, double stagger = 0);
  void project(MutableBodyColumns state);

  // Finds the impulse at the pose `start` that closes all joints at the end of a drift of length h [s] with the
  // velocities of `start`, to `within` times size() or to rounding. `attempt` takes the wrench columns of an impulse
  // and returns the end of a drift with it; its last call has the final impulse. Returns false if there seems to be no
  // such impulse, because bodies turn too far in h.
  bool close(BodyColumns start, double h, const std::function<BodyColumns(const double* impulse)>& attempt,
             double within = 0);
  // Notes as a warning what gap is left at a state, if there is one.
  void warn_of_gap(BodyColumns state) { warn_of_gap(rows_.measure_gaps(state)); }
  // Adds an impulse to v and w at the pose of the last factorisation.
  void push(const double* impulse, MutableBodyColumns state) const { rows_.push(impulse, state); }

  // The largest |g| at a state [m]. A sine counts times the longest arm.
  double gap(BodyColumns state) { return rows_.measure_gaps(state); }

  // Sets the function of the row of a joint's coordinate; see joint_rows.h. Call count_rows() after the last change.
  void set_coordinate(std::size_t joint, CoordinateRow row, double target, double rate);
  // Counts anew at a state where the joints are closed which rows repeat others.
  void count_rows(BodyColumns state);
  // After hold() the effort on b that a coordinate's row takes [N m, N], after velocity_impulse() the impulse; 0
  // without a row.
  double coordinate_effort(std::size_t joint) const;
  // After hold(): x'' of a coordinate.
  double coordinate_acceleration(std::size_t joint, BodyColumns state) const;
  // N: the largest multiplier of the last solution, which the rounding of efforts is measured against. A torque counts
  // divided by size().
  double largest_force() const;

  // Bodies that joints connect make a component; a body without joints is in none, -1.
  int components() const { return factor_.components(); }
  int component_of(int body) const { return component_of_body_[body]; }
  const std::vector<int>& bodies_of(int component) const { return bodies_of_component_[component]; }
  // At the pose of the last factorisation: takes from changes of velocity, by body, of a component what its joints do
  // not allow.
  void restrict(int component, std::vector<Vec6>& change);

  // That of the last factorisation; see block_cholesky.h.
  double smallest_pivot() const { return factor_.smallest_pivot(); }
  std::size_t joint_of_smallest_pivot() const { return factor_.joint_of_smallest_pivot(); }

  double size() const { return size_; }  // m: the longest arm of an end that moves, what gaps are small against
  // Rows of all joints, and their rank.
  int rows() const;
  int rank() const { return factor_.rank(); }

  // Why the work since begin_step() is less than what was requested; empty if it is not.
  void begin_step() { warning_.clear(); }
  // Notes where a hinge with a spring has turned by half a turn, at which the angle that the spring goes by jumps; and
  // where three hinges in series pass a position in which their angles are not unique.
  void end_step(BodyColumns state);
  void archive_state(StateArchive& archive);
  std::string warning() const { return at_start_.empty() ? warning_ : at_start_; }
  // Supports trial steps: read the notes, try a step, and restore them if the step is discarded.
  const std::string& noted() const { return warning_; }
  void note_only(std::string warning) { warning_ = std::move(warning); }

 private:
  // joints_at_start.cpp
  void find_ranks(BodyColumns state);
  void look_for_contradictions();
  void look_for_singularity(BodyColumns start);
  void look_for_parallel_hinges(BodyColumns state);

  void list_components();
  void factorise(BodyColumns state, Rows rows);
  template <typename RightSide>
  void solve_for(const RightSide& right_side) {
    for (std::size_t k = 0; k < rows_.size(); ++k) multipliers_[k] = right_side(rows_.joint(k));
    solve();
  }
  void solve();  // for the right side in multipliers_
  void refine();
  const double* impulse_against_velocities(bool with_rotors = false);
  void aim_rotors(BodyColumns start, double h);
  void turn_rotors();
  double rotor_change(std::size_t k, const std::vector<Vec6>& impulses) const;
  void aim_driven_coordinates(BodyColumns start, double h);
  void close_pose(MutableBodyColumns state);
  bool is_closed(double gap, double last, double within = 0) const;
  void warn_of_gap(double gap);
  void warn_if_singular();

  const System& system_;
  std::vector<std::string> names_;
  JointRows rows_;
  BlockCholesky factor_;
  std::vector<double> rotor_;          // rad/s, m/s: by joint
  std::vector<double> rotor_impulse_;  // by joint: what its rotor gave to the last impulse of a coordinate that is kept
  std::vector<Vec6> multipliers_, total_multipliers_, right_side_, correction_;  // by joint
  std::vector<Vec6> free_;  // by body: accelerations without joints
  std::vector<int> component_of_body_;
  std::vector<std::vector<int>> bodies_of_component_, joints_of_component_;  // bodies that can move
  Columns total_;
  double extent_ = 1, size_ = 1;  // m: the longest arm, and that of an end that moves
  struct SprungHinge {
    JointCoordinate coordinate;
    std::size_t joint;
    double x;  // rad, when the last step ended
  };
  std::vector<SprungHinge> sprung_;
  struct ThreeHinges {  // of a compound joint
    AxisSeries series;
    std::size_t joint, first;  // the first hinge among its axes
    double x;                  // rad, of the first hinge, when the last step ended
  };
  std::vector<ThreeHinges> three_hinges_;
  std::string at_start_, warning_;
};

}  // namespace rigor::inline dynamics
