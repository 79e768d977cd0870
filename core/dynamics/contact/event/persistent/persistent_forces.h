// The forces at points that stay in contact, as the equations of motion see them at an instant, for the method `event`.
// With J the rows of velocities that have to stay zero, P the directions that the forces act along, and V' the
// accelerations,
//   M V' = f + Pᵀ l,   J V' = -J'V.
// A point that sticks or rolls has three rows in both. A sliding point has its normal n in J, and n - mu t in P, with t
// the direction of its slip: Coulomb's force. If the points outnumber the degrees of freedom, nearly the smallest l is
// taken (force_equations.h), each island alone. With joints V' is the part of the accelerations under f that they
// allow, and M⁻¹ the part of the inverse masses (impulse_responses.h). A limit of a joint is a sliding point without
// friction.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/dynamics/contact/event/contact_points.h"
#include "core/dynamics/contact/event/features/feature_ends.h"
#include "core/dynamics/contact/event/persistent/force_equations.h"
#include "core/dynamics/joints/islands.h"
#include "core/dynamics/model/constraint_forces.h"
#include "core/engine/columns.h"

namespace rigor::inline dynamics {

struct PersistentPoint {
  enum class Mode : std::uint8_t { sticks, slides } mode = Mode::sticks;
  ContactPoint contact;  // as it was at the start
  FeaturePair features;
  // Unit, in W: of the slip at the start, or of how it begins.
  Vec3 slip_direction = Vec3::Zero();
  bool begins_to_slip = false;
  double tangential_mass = 0;  // kg, the least, at the start
  double turn_rate = 0;        // rad/s, of the slip's direction at the start
  double passes_at = 0;        // m: the distance from the ends of its features at which it passes to others

  // At the last instant asked for.
  ContactKinematics kinematics;
  Mat3 frame = Mat3::Identity();                      // columns: the normal and two tangents
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();    // m, in W
  Vec3 velocity = Vec3::Zero(), bias = Vec3::Zero();  // m/s and m/s², of a against b, in the frame
  Vec3 force = Vec3::Zero();                          // N, in the frame
  Vec3 force_in_cone = Vec3::Zero();                  // N, that the modes were last found with
  double slip = 0;                                    // m/s, along slip_direction
  double least_slip = 0, largest_slip = 0;            // m/s, at all instants since begin_attempt()

  double friction() const { return contact.cone.friction; }
  double static_friction() const { return contact.static_friction; }
  // The contact's as it is at that instant.
  ConeConstraint cone() const {
    ConeConstraint now = contact.cone;
    now.arm_a = arm_a, now.arm_b = arm_b, now.frame = frame;
    return now;
  }
};

class PersistentForces : public ConstraintForces {
 public:
  // `joints`, which may be null, must outlive it.
  PersistentForces(const System& system, const ContactPoints& contact_points, Joints* joints);

  const ContactScales& scales() const { return contact_points_.scales(); }
  std::vector<PersistentPoint>& points() { return points_; }
  const std::vector<PersistentPoint>& points() const { return points_; }

  const double* hold(BodyColumns state, const double* wrench, Rows rows) override;

  // The positions and velocities of the points at `state`, and the rates of their velocities without any acceleration.
  // Part of hold().
  void place(BodyColumns state);
  // Takes from the velocities what the points must not have, by impulses along the directions of their forces. A point
  // that slides gets friction with its normal impulse. The small bounces that this replaces have it as well, so that it
  // does not matter how many of them are resolved before. A slip that begins counts as sticking. Call place() before.
  void stop(MutableBodyColumns state);
  // V' of a body under the loads alone: linear and angular.
  std::pair<Vec3, Vec3> free_acceleration(BodyColumns state, const double* wrench, int body) const;
  // Of a point at `state`, under wrench columns of everything that acts on the bodies [m/s²].
  double normal_acceleration(BodyColumns state, const double* total, const PersistentPoint& point) const;
  // m: of the point from the ends of its features at `state`, for which place() was called.
  double distance_from_ends(BodyColumns state, const PersistentPoint& point) const;
  bool has_friction_of_slip() const;
  double largest_force() const;  // N, of one point
  // The most that was on each body at any instant since begin_attempt().
  const std::vector<Loading>& largest_loads() const { return largest_; }
  void begin_attempt();
  long times_asked() const { return times_asked_; }  // by hold(), ever

 private:
  void find_islands();
  void place_limit(BodyColumns state, PersistentPoint& point) const;
  enum class Slips { as_chosen, not_yet };  // those that begin
  void list_rows(const Island& island, Slips slips);
  template <typename RatesOf>
  Eigen::VectorXd take_up(const Island& island, BodyColumns state, const RatesOf& rates_of);
  void add_row(std::size_t point, int axis, const Vec3& direction, const Vec3& force, double bias);
  Eigen::VectorXd response_to(const ConeConstraint& at, const Vec3& force);
  void solve(const Island& island, BodyColumns state, const double* wrench);
  void add_wrenches_through_joints(const Island& island, Eigen::Index size);
  void copy_wrench(const double* wrench);
  void note_loads_of_joints(const double* wrench);
  void add_pushes();
  void set_forces();

  const System& system_;
  const ContactPoints& contact_points_;
  Joints* joints_;
  ForceEquations equations_;  // of the island at hand
  std::optional<ImpulseResponses> through_joints_;
  std::vector<Mat3> inertia_root_B_;  // G with G Gᵀ the inverse inertia, of each body
  std::vector<PersistentPoint> points_;
  std::vector<Island> islands_;
  std::vector<int> place_;    // of each body in its island, or -1
  std::vector<Mat3> root_W_;  // R G, by place
  std::vector<int> island_;   // bodies of the island at hand, by place
  long times_asked_ = 0;
  Columns wrench_;
  std::vector<Loading> now_, largest_;  // by body
};

}  // namespace rigor::inline dynamics
