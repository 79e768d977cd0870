// The rows of all joints of a scene at one state, and their products: S = J M⁻¹ Jᵀ, wrenches Jᵀ l, and the effect of a
// wrench on velocities and poses. A hinge or slider with limits or a motor of given speed has one more row, for its
// coordinate, while the coordinate is kept at a limit or driven at a speed. With an armature I the coordinate carries a
// rotor of speed u = x'. Its row says J V = u with I u' = -l, so S has 1/I more on the diagonal. While x' is kept or
// driven the rotor turns evenly and takes no effort. Behind the joints stand the rows of couplings.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/dynamics/joints/block_cholesky.h"
#include "core/dynamics/joints/joint_constraint.h"
#include "core/dynamics/model/coupled_coordinates.h"
#include "core/dynamics/model/joint_coordinate.h"
#include "core/dynamics/model/system.h"
#include "core/engine/columns.h"

namespace rigor::inline dynamics {

// The function of the row of a coordinate x.
enum class CoordinateRow {
  none,    // nothing, or its rotor: x is free
  kept,    // x = target; an impulse leaves x' = rate
  driven,  // x' = rate
};

struct JointRow {  // all rows of a joint, or of a coupling
  static constexpr int kMostEnds = 4;
  std::unique_ptr<JointConstraint> constraint;   // of a joint,
  std::unique_ptr<CoupledCoordinates> coupling;  // or of a coupling
  int ends = 2;
  int rows = 0, most_rows = 0;  // of the joint alone; room, with its coordinate's if it can have one
  int end[kMostEnds] = {kWorld, kWorld, kWorld, kWorld};   // the bodies at its ends
  int body[kMostEnds] = {kWorld, kWorld, kWorld, kWorld};  // those of them that can move, or kWorld
  std::array<bool, kMostRows> keeps_angle = {};            // of each row: its gap is in rad, its multiplier in N m
  double J[kMostEnds][6 * kMostRows] = {};                 // most_rows x 6, column by column
  double Y[kMostEnds][6 * kMostRows] = {};                 // J M⁻¹
  Vec6 gap = Vec6::Zero(), bias = Vec6::Zero();            // zero beyond the rows in use

  std::optional<JointCoordinate> coordinate = {};  // if it has limits, a motor of given speed or an armature
  CoordinateRow row = CoordinateRow::none;
  double target = 0, rate = 0;  // of the coordinate
  double armature = 0;          // kg m², kg

  bool carries_rotor() const { return armature > 0 && row == CoordinateRow::none; }
  bool has_coordinate_row() const { return armature > 0 || row != CoordinateRow::none; }
  int rows_in_use() const { return rows + (has_coordinate_row() ? 1 : 0); }
};

class JointRows {
 public:
  // The system must outlive it.
  JointRows(const Scene& scene, const System& system);

  std::size_t size() const { return joints_.size(); }
  JointRow& joint(std::size_t k) { return joints_[k]; }
  const JointRow& joint(std::size_t k) const { return joints_[k]; }
  const std::vector<JointRow>& joints() const { return joints_; }
  const std::vector<int>& moved() const { return moved_; }  // bodies at the ends of joints

  BlockCholesky make_factor();

  // Takes J, gaps and biases from a state; a coordinate that is driven has no gap.
  void evaluate(BodyColumns state);
  // The longest arm of a joint [m], the scale of gaps: it converts a rotation to a gap, as the ratio of a row's torque
  // to its force. It is that of the last evaluated rows. The arm of a fixed end is its distance from the origin and
  // gives the scale of rounding. The arms of moving ends give the size of the mechanism. If no row has an arm, it is
  // the longest distance between the two ends of a joint, or 1 if they coincide.
  double longest_arm() const { return longest_arm(false); }
  double longest_moving_arm() const { return longest_arm(true); }
  // m: multiplies gaps that are sines or angles, so that no unit of length decides what is closed. For the rows
  // evaluated last; 1 before the first call.
  void set_lever(double lever);
  // N: the largest of such multipliers. Those of rows that keep an angle are divided by the lever.
  double largest_force(const std::vector<Vec6>& multipliers, double lever) const;
  // Fills in S of the rows evaluated last.
  void assemble(BlockCholesky& factor);
  // The gaps alone, at other poses; a coordinate that is driven is to be at its target. The largest |gap| [m], with
  // sines and angles times the lever; not a number if one is not.
  double measure_gaps(BodyColumns state);
  double largest_gap() const;

  // All at the pose that was evaluated last. Wrenches in columns (kernels.h) of stride().
  std::size_t stride() const { return wrench_.stride(); }
  const double* wrench_of(const std::vector<Vec6>& multipliers);  // Jᵀ l; valid until the next call
  const double* last_wrench() const { return wrench_.data(); }    // of the last call
  Vec6 times_velocity(const JointRow& joint) const;               // J V, as evaluated
  Vec6 times_acceleration(const JointRow& joint, const std::vector<Vec6>& by_body) const;  // J a
  Vec6 response(const JointRow& joint, const double* wrench) const;                        // J M⁻¹ times a wrench
  double response_size(const JointRow& joint, const double* wrench) const;  // the largest of its terms' sizes
  // M⁻¹ Jᵀ l of one joint, to changes of velocity by body.
  void add_response(const JointRow& joint, const Vec6& multiplier, std::vector<Vec6>& by_body) const;
  Vec6 free_acceleration(int body, const double* wrench) const;      // of gravity and a wrench, or null
  Vec6 acceleration_by(int body, const double* wrench) const;        // M⁻¹ times a wrench
  void push(const double* impulse, MutableBodyColumns state) const;  // adds M⁻¹ times an impulse to v and w,
  void note_velocities(BodyColumns state);                           // and then reads these for times_velocity()
  void move(const double* wrench, MutableBodyColumns state) const;   // by M⁻¹ times it [m, rad]

 private:
  struct SharedBody {  // two joints on a body
    std::int32_t first, second;
    std::int8_t first_end, second_end;
    EliminationOrder::Place place;
  };
  struct Frame {  // of a body that some joint moves
    EndMotion motion;
    Mat3 inverse_inertia_W;  // 1/(kg m²)
  };
  double longest_arm(bool of_moving_ends) const;
  double longest_distance() const;
  void add_joint(const Scene& scene, std::size_t k);
  void add_coupling(const Scene& scene, const Coupling& coupling, JointRow& row);
  void note_ends(JointRow& row);
  void list_shared_bodies();
  void evaluate_frame(int body, BodyColumns state);
  void evaluate_coordinate(JointRow& joint, BodyColumns state);
  static void evaluate_coupling(JointRow& joint, BodyColumns state);

  const System& system_;
  std::vector<JointRow> joints_;
  std::vector<int> moved_;
  std::vector<Frame> frames_;         // by body
  std::vector<Vec6> on_body_;         // the wrench being summed
  std::vector<EndMotion> elsewhere_;  // the poses of measure_gaps()
  std::vector<SharedBody> shared_;
  Columns wrench_;
  double lever_ = 1;  // m
};

// A body's column of wrench columns.
Vec6 wrench_at(const double* columns, std::size_t stride, int body);

}  // namespace rigor::inline dynamics
