// The vector types of the whole project. Everything is double precision and SI.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "core/base/portable.h"

namespace rigor {

using Vec3 = Eigen::Vector3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;  // (w, x, y, z); takes the body frame B to the world frame W

// The matrix of a cross product: cross_matrix(a) * b == a x b.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

// The unit quaternion of a rotation by the vector `angle` [rad], about its direction, by its length.
inline Quat rotation_by(const Vec3& angle) {
  const double theta = angle.norm();
  // sin(theta/2)/theta from its series where the quotient would lose digits; the next term is below 1e-17 there.
  const double s = theta < 1e-4 ? 0.5 - theta * theta / 48.0 : portable::sin(0.5 * theta) / theta;
  return {portable::cos(0.5 * theta), s * angle.x(), s * angle.y(), s * angle.z()};
}

// The matrix of a quaternion of any length, from B to W: (w² - u·u) I + 2 u uᵀ + 2 w [u]x. For a unit quaternion it is
// a rotation. Otherwise it is |q|² times a rotation, so that a lost norm stays visible. Elements are written one by
// one: every file reads this header, and Eigen's matrix expressions compile slowly.
inline Mat3 matrix_of(const Quat& q) {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const double diagonal = w * w - (x * x + y * y + z * z), xx = 2 * x, yy = 2 * y, zz = 2 * z, ww = 2 * w;
  Mat3 m;
  m(0, 0) = diagonal + xx * x, m(0, 1) = xx * y - ww * z, m(0, 2) = xx * z + ww * y;
  m(1, 0) = yy * x + ww * z, m(1, 1) = diagonal + yy * y, m(1, 2) = yy * z - ww * x;
  m(2, 0) = zz * x - ww * y, m(2, 1) = zz * y + ww * x, m(2, 2) = diagonal + zz * z;
  return m;
}

// Angle [rad], in [0, pi], of the rotation between two orientations; a quaternion and its negative are the same one.
inline double angle_between(const Quat& a, const Quat& b) {
  const Quat d = a.conjugate() * b;
  return 2.0 * portable::atan2(d.vec().norm(), std::abs(d.w()));
}

}  // namespace rigor
