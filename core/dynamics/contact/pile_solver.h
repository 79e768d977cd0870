// Velocity-level contact for many points, in small sub-steps of length h (Macklin et al., Small steps in physics
// simulation, 2019; Catto, Solver2D, 2024). In each, bodies first move freely; then two passes take the points in turn,
//   p_n <- max(0, p_n - (u_n + bias) / k_n),   p_t <- onto the disc of radius mu p_n (p_t - u_t / k_t),
// starting from the impulses of the sub-step before. In the first pass a point that is apart may close its gap within
// h, and one that overlaps is pushed out as by a damped spring, stiff for h; positions follow this pass. The second
// has no bias, so that what pushed bodies out leaves them no speed. Then points that came together faster than gravity
// can have brought them within a few h get their restitution.
#pragma once

#include <vector>

#include "core/dynamics/contact/manifolds.h"
#include "core/dynamics/system.h"

namespace rigor {

class PileSolver {
 public:
  // `share`: of h for which the velocity after a sub-step counts in its way: 1 for a semi-implicit method, 1/2 for one
  // that takes the mean of the velocities before and after.
  PileSolver(const System& system, const std::vector<Collider>& colliders, double share);

  // For a step of sub-steps h over these points, which take the impulses with them when it ends.
  void begin_step(BodyColumns state, std::vector<PilePoint>& points, double h);
  void begin_sub_step(BodyColumns state);
  void first_pass(MutableBodyColumns state);
  void second_pass(MutableBodyColumns state);
  void end_step();

 private:
  struct Motion {
    Vec3 v = Vec3::Zero(), w = Vec3::Zero();
    double inverse_mass = 0;
    Mat3 inverse_inertia = Mat3::Zero();  // in W, at the step's start
    Vec3 start = Vec3::Zero();            // m, at the step's start
    Quat start_orientation = Quat::Identity();
    Vec3 way = Vec3::Zero(), turn = Vec3::Zero();       // m and rad since then
    Vec3 free_v = Vec3::Zero(), free_w = Vec3::Zero();  // without contact in this sub-step
  };
  struct Row {
    int a, b;
    Vec3 n, t, s;               // the normal and two tangents, in W
    Vec3 arm_a, arm_b;          // m
    Vec3 arm_a_n, arm_b_n;      // arm x n
    Vec3 spin_a_n, spin_b_n;    // what a unit normal impulse adds to w
    double gap, give_n;         // m, 1/kg
    double pace_t;              // kg, 1 / the larger eigenvalue of the tangential give
    Eigen::Matrix2d inverse_t;  // kg, the inverse of that give
    double friction, restitution;
    double p_n = 0;  // N s, of one sub-step
    Eigen::Vector2d p_t = Eigen::Vector2d::Zero();
    double gap_now = 0, approach = 0;  // m, m/s, before the sub-step
  };

  void read(BodyColumns state);
  void write(MutableBodyColumns state) const;
  void add_row(const PilePoint& point);
  void push(const Row& row, double n, const Eigen::Vector2d& t);
  void push_normal(const Row& row, double n);
  double normal_velocity(const Row& row) const;
  void solve_friction(Row& row);
  void rebound();
  void follow(MutableBodyColumns state) const;

  const System& system_;
  const std::vector<Collider>& colliders_;
  double share_;
  double h_ = 0, old_h_ = 0;                                   // s
  double rest_speed_ = 0;                                      // m/s
  double push_rate_ = 0, mass_share_ = 0, impulse_share_ = 0;  // of the spring and damper
  std::vector<PilePoint>* points_ = nullptr;
  std::vector<Motion> motions_;  // by body
  std::vector<Row> rows_;
  bool any_rebound_ = false;
};

}  // namespace rigor
