// The loads of joints: the forces and couples that keep their constraints' second derivatives zero at a given state,
//   M a = f + Jᵀ λ,   J a + b = 0   =>   J M⁻¹ Jᵀ λ = -(J M⁻¹ f + b),
// where f contains gravity, springs, timed forces and loads along the joints' free axes, and b the centripetal terms.
//
// If rows of J depend on each other (a plane mechanism's loop of hinges), joints may also carry loads that balance each
// other, the null space of Jᵀ. The motion does not determine them. A reaction is unique only in the directions without
// such loads, and only these are compared.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/metrics/measures/joints/joint_geometry.h"
#include "cases/truth/solved/jointed/constraint_rows.h"
#include "core/dynamics/model/system.h"

namespace rigor::inline metric {

// On b, at the joint's point (joint_geometry.h), and about it; the opposite on a. In W.
struct JointReaction {
  Vec3 force = Vec3::Zero();   // N
  Vec3 couple = Vec3::Zero();  // N m
};

// Projections onto the directions in which a reaction is unique; zero if the joint has none with a load.
struct UniqueReaction {
  Mat3 force = Mat3::Identity(), couple = Mat3::Identity();
};

// Why the equations of motion alone do not determine the joint loads of the scene; empty if they do.
std::string why_reactions_are_unknown(const Scene& scene);

class JointReactions {
 public:
  explicit JointReactions(const Scene& scene);  // which has to outlive it

  // One for each joint at t [s]; nothing at a singular position. Of a joint's reaction the parts that are not unique
  // are some that the equations allow.
  std::optional<std::vector<JointReaction>> at(BodyColumns bodies, double t);
  // At the state that at() was last asked for, where the joints have to hold, so a truth's; nothing where singular.
  std::optional<std::vector<UniqueReaction>> unique();

 private:
  using Rows = ConstraintRows<double, 6>;  // velocities: v, w in W
  using Row = Rows::Row;
  using Block = Rows::Block;

  // One row and the unit of force and couple that it can put on b.
  struct Held {
    std::size_t joint;
    Vec3 force, couple;
  };

  void find_rows(BodyColumns bodies);
  void add_rows_of(std::size_t joint, BodyColumns bodies);
  void add_row(std::size_t joint, const MovingEnd& a, const MovingEnd& b, const Vec3& force, const Vec3& couple,
               double bias);
  void add_point_row(std::size_t joint, const MovingEnd& a, const MovingEnd& b, const Vec3& direction);
  void add_angle_row(std::size_t joint, const MovingEnd& a, const MovingEnd& b, const Vec3& of_a, const Vec3& of_b);
  std::vector<JointReaction> carried(const std::vector<double>& residuals);

  const Scene& scene_;
  System system_;
  std::vector<JointGeometry> joints_;
  std::vector<int> order_;  // of each body: its place among those that move; -1 if fixed
  std::vector<Row> rows_;   // at the state last asked for
  std::vector<Held> held_;
  std::vector<Rows::InverseMass> inverse_mass_;
  Rows solver_;
  bool is_regular_ = true;
};

}  // namespace rigor::inline metric
