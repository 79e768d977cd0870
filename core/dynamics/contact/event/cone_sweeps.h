// The sweeps of cone_solver.h over the points of one island. They apply the laws at one point after another, each with
// the velocity after the previous impulses. Data that every sweep needs of a point are computed once, and the speeds of
// the bodies are contiguous.
#pragma once

#include "core/dynamics/contact/event/cone_solver.h"

namespace rigor::inline dynamics {

class ConeSweeps {
 public:
  // `inverse_inertia_W` and `responses` must outlive it.
  ConeSweeps(const System& system, const std::vector<Mat3>& inverse_inertia_W,
             const std::vector<ConeSolver::Response>& responses)
      : system_(system), inverse_inertia_W_(inverse_inertia_W), responses_(responses), place_(system.size(), -1) {}

  // For points that ConeSolver::prepare() has seen.
  void set_up(BodyColumns state, const std::vector<ConeConstraint>& points);
  // Changes the points' impulses. Returns the largest change of a point's velocity [m/s].
  double sweep(std::vector<ConeConstraint>& points);
  // If the last sweeps converged slowly in one direction, adds the remaining change at once (Aitken, 1926). Returns
  // whether it did.
  bool leap(std::vector<ConeConstraint>& points);
  // The bodies' velocities, which sweep() keeps to itself.
  void read(BodyColumns state);
  void write(MutableBodyColumns state) const;

 private:
  // Three rows, and one of zeros to fill whole registers.
  using Side = Eigen::Matrix<double, 4, 6>;
  using Effect = Eigen::Matrix<double, 6, 3>;
  struct Row {
    int a = -1, b = -1;                                   // places of the moving bodies; -1 for immovable ones
    Side by_a = Side::Zero(), by_b = Side::Zero();        // of the point's velocity, to a body's six speeds
    Effect to_a = Effect::Zero(), to_b = Effect::Zero();  // the effect of an impulse on them
    Eigen::Vector4d given = Eigen::Vector4d::Zero();      // m/s: the offset
    Mat3 sticking = Mat3::Zero();                         // kg, of the impulse, to minus the velocity
  };

  int place_of(int body);
  Row row_of(const ConeConstraint& point);
  Vec3 velocity_at(const Row& row) const;
  void push(const ConeConstraint& point, const Row& row, const Vec3& impulse);

  const System& system_;
  const std::vector<Mat3>& inverse_inertia_W_;
  const std::vector<ConeSolver::Response>& responses_;  // through joints
  std::vector<Row> rows_;
  std::vector<Vec3> change_, change_before_;  // N s, of the impulses in the last two sweeps
  std::vector<int> place_, bodies_;           // by body of the system, or -1; those that move
  std::vector<Vec6> speeds_;                  // of these
};

}  // namespace rigor::inline dynamics
