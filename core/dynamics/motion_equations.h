// The equations of motion as one system y' = f(y) of first order, for Runge–Kutta methods. Each body has x, v, its
// angular momentum L in W and its orientation:
//   x' = v,  v' = F/m,  L' = tau,  with w from L and the orientation.
// The orientation is either a quaternion, q' = (0, w) q / 2, of which only the direction counts, or the rotation vector
// phi from the step's start, R = exp([phi]x) R0, with (Iserles, Munthe-Kaas, Nørsett, Zanna, Lie-group methods, 2000)
//   phi' = w - phi x w / 2 + phi x (phi x w) / 12 + O(phi⁴).
// The series is cut there, which leaves methods up to order 4 their order.
#pragma once

#include "core/dynamics/system.h"

namespace rigor {

enum class OrientationChart { quaternion, rotation_vector };

class MotionEquations {
 public:
  using Vector = Eigen::Ref<const Eigen::VectorXd>;

  MotionEquations(const System& system, OrientationChart chart);
  Eigen::Index dimension() const { return width_ * static_cast<Eigen::Index>(system_.size()); }

  // Reads y from `state`, from which rotation vectors count until the next call.
  void begin(BodyColumns state, Eigen::VectorXd& y);
  // f(y), with the timed forces' mean over the step [t, t + dt].
  void rates(const Vector& y, double t, double dt, Eigen::Ref<Eigen::VectorXd> out);
  // Writes y to the bodies that are not fixed.
  void write(const Vector& y, MutableBodyColumns state) const;

  // How large a change of y is, for quaternions: the sum of |dx|/(1 m + |x|), |dv|/(1 m/s + |v|),
  // |dw|/(1 rad/s + |w|) and the angle [rad], with dw what the change of L makes of w; the largest over all bodies.
  double relative_size(const Vector& change, const Vector& y) const;

 private:
  Quat orientation_of(const Vector& y, std::size_t body) const;
  Eigen::Index at(std::size_t body) const { return width_ * static_cast<Eigen::Index>(body); }

  const System& system_;
  OrientationChart chart_;
  Eigen::Index width_;  // numbers a body: x, v, L, orientation
  std::vector<Quat> start_;
  BodyTable stage_;
  Wrenches wrenches_;
};

}  // namespace rigor
