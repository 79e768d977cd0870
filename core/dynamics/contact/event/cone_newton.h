// The contact laws of cone_solver.h by Newton's method, in the velocities of the bodies: each impulse is what its
// point's velocity u asks for,
//   p_n = max(0, c_n - r (u_n - target)),   p_t = c_t - r u_t, put onto the disc of radius mu p_n,
// about centres c, which are the impulses of the previous round (the augmented Lagrangian of Alart and Curnier, 1991).
// At the end of the rounds p = c and the laws hold for any r. The method ends in a few steps where Gauss–Seidel
// converges slowly: several points on a stiff body, or one on the verge of sliding. If the points outnumber the degrees
// of freedom, undetermined parts of the impulses stay unchanged, because nothing is ever divided by an almost zero
// number.
#pragma once

#include "core/base/factors.h"
#include "core/dynamics/contact/event/cone_solver.h"

namespace rigor::inline dynamics {

class ConeNewton {
 public:
  // Bodies at the points beyond which it is not worth it: its cost grows as their cube.
  static constexpr int kMostBodies = 64;

  ConeNewton(const System& system, const std::vector<Mat3>& inverse_inertia_W,
             const std::vector<ConeSolver::Response>& responses)
      : system_(system), inverse_inertia_W_(inverse_inertia_W), responses_(responses) {}

  // Changes the points' impulses until none would change a velocity by more than `tolerance` [m/s], or there is no
  // progress, or the `steps`, which it counts down, are used up. The caller changes the velocities. Returns false if
  // there are too many bodies.
  bool solve(BodyColumns state, std::vector<ConeConstraint>& points, double tolerance, int& steps);

 private:
  using Side = Eigen::Matrix<double, 3, 6>;  // of a point's velocity, to one body's six speeds
  struct Row {
    int a = -1, b = -1;  // of the moving bodies; -1 for a fixed one
    Side by_a = Side::Zero(), by_b = Side::Zero();
    std::vector<std::pair<int, Eigen::Matrix<double, 6, 3>>> to;  // the change of speeds by an impulse, by moving body
    Vec3 start, known, centre, impulse;  // m/s at first; N s: that `start` knows, of this round, now
    double mass;                         // kg, the point's own
    Mat3 slope = Mat3::Zero();           // kg, of the impulse, to minus the velocity
  };

  struct Fit {
    double energy = 0;    // J; falls along every step while friction is not coupled
    double residual = 0;  // m/s
  };

  bool set_up(BodyColumns state, const std::vector<ConeConstraint>& points);
  Fit assess(const std::vector<ConeConstraint>& points, const Eigen::VectorXd& change);
  double take_impulse(const ConeConstraint& point, const Vec3& u, Row& row) const;
  Fit take_step(const std::vector<ConeConstraint>& points);
  Vec3 velocity_of(const Row& row, const Eigen::VectorXd& speeds) const;

  const System& system_;
  const std::vector<Mat3>& inverse_inertia_W_;
  const std::vector<ConeSolver::Response>& responses_;  // through joints
  std::vector<Row> rows_;
  std::vector<int> bodies_;  // those that move
  std::vector<Mat3> inertia_W_;
  double steepness_ = 0;               // r, in units of a point's mass
  bool is_coupled_ = false;            // friction is bounded by this step's normal impulse, not by the round's
  Eigen::VectorXd change_, residual_;  // of the moving bodies' speeds, six each
  Eigen::MatrixXd derivative_;
  DenseFactors factors_;  // of it
};

}  // namespace rigor::inline dynamics
