// The contact laws of cone_solver.h as a system of equations without inequalities,
//   p_n = max(0, p_n - r (u_n - wanted)),   p_t = onto the disc of radius mu p_n (p_t - s u_t),
// solved by Newton's method with the derivative of the piece at hand (Alart and Curnier, 1991). It ends in a few steps
// where Gauss–Seidel creeps: several points on a stiff body, or one on the verge of sliding. Where the points are more
// than the motion can tell apart, a touch of damping picks one of the solutions.
#pragma once

#include "core/dynamics/contact/cone_solver.h"

namespace rigor {

class ConeNewton {
 public:
  // `coupling`: what the impulses make of the velocities, three rows and columns a point; `velocities`: those that are
  // there now. Changes the impulses, and returns their change; where nothing better was found, zero.
  Eigen::VectorXd solve(const Eigen::MatrixXd& coupling, const Eigen::VectorXd& velocities,
                        const std::vector<ConePoint>& points, double tolerance);

 private:
  double assemble(const Eigen::MatrixXd& coupling, const std::vector<ConePoint>& points);
  void assemble_friction(const Eigen::MatrixXd& coupling, const ConePoint& point, Eigen::Index at);

  Eigen::VectorXd p_, u_, residual_;
  Eigen::MatrixXd derivative_;
};

}  // namespace rigor
