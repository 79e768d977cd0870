// A body in natural coordinates (natural_coordinates.h): its centre x, the directions d_1, d_2, d_3 of its axes, and
// their rates.
#pragma once

#include <Eigen/Geometry>

namespace rigor::inline truth {

template <typename Real>
struct NaturalFrame {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  using Matrix = Eigen::Matrix<Real, 3, 3>;
  using Block = Eigen::Matrix<Real, 12, 1>;
  static constexpr int kNumbers = 24;  // of a body: x, d_1, d_2, d_3 and their rates

  Vector x = Vector::Zero(), dx = Vector::Zero();
  Matrix R = Matrix::Identity(), dR = Matrix::Zero();  // columns d_i and d_i'
  Block force = Block::Zero();                         // generalised: on x, then on each d_i

  Vector point(const Vector& in_B) const { return x + R * in_B; }
  Vector rate_of(const Vector& in_B) const { return dx + dR * in_B; }
  // The mean over the axes, for where d_i are not quite at right angles.
  Vector w() const {
    Vector sum = Vector::Zero();
    for (int i = 0; i < 3; ++i) sum += Vector(R.col(i)).cross(Vector(dR.col(i)));
    return sum / 2;
  }
  // Of d_1.d_1, d_1.d_2, d_1.d_3, d_2.d_2, d_2.d_3 and d_3.d_3, by column.
  Eigen::Matrix<Real, 12, 6> gradients() const {
    Eigen::Matrix<Real, 12, 6> all = Eigen::Matrix<Real, 12, 6>::Zero();
    for (int i = 0, k = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j, ++k) {
        all.col(k).template segment<3>(3 + 3 * i) += R.col(j);
        all.col(k).template segment<3>(3 + 3 * j) += R.col(i);
      }
    }
    return all;
  }
  void push(const Vector& f, const Vector& at_B) {
    force.template head<3>() += f;
    for (int i = 0; i < 3; ++i) force.template segment<3>(3 + 3 * i) += at_B[i] * f;
  }
  void turn(const Vector& torque) {
    for (int i = 0; i < 3; ++i) force.template segment<3>(3 + 3 * i) += torque.cross(Vector(R.col(i))) / 2;
  }

  static NaturalFrame read(const Real* s) {
    using Map = Eigen::Map<const Vector>;
    NaturalFrame frame;
    frame.x = Map(s), frame.dx = Map(s + 12);
    for (int i = 0; i < 3; ++i) frame.R.col(i) = Map(s + 3 + 3 * i), frame.dR.col(i) = Map(s + 15 + 3 * i);
    return frame;
  }
};

}  // namespace rigor::inline truth
