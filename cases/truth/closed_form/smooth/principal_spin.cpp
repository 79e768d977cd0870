#include "cases/truth/closed_form/smooth/principal_spin.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace rigor::inline truth {

PrincipalSpin::PrincipalSpin(const Body& body, const Vec3& axis) : start_(extended(body.orientation)) {
  if (axis.isZero(0)) return;
  axis_ = extended(axis).normalized();
  const ExtendedMat3 inertia = extended(body.inertia);
  const ExtendedVec3 n = start_.conjugate() * axis_, torque = n.cross(inertia * n);
  const ExtendedVec3 moments = Eigen::SelfAdjointEigenSolver<ExtendedMat3>(inertia).eigenvalues();
  moment_ = n.dot(inertia * n);
  misses_axis_ = torque.norm() / inertia.norm();
  wobble_ = (inertia.inverse() * torque).norm();
  // Euler's equations, linearised about the spin: stable about the largest and the smallest moment.
  const Extended instability = (moment_ - moments[0]) * (moments[2] - moment_) / (moments[0] * moments[2]);
  growth_ = std::sqrt(std::max<Extended>(0, instability));
}

double PrincipalSpin::error(double angle) const {
  const double rounding = 4 * kExtendedEpsilon * angle;
  if (wobble_ == 0) return rounding;
  const Extended wobble = wobble_ * angle * (1 + angle / 2) * std::cosh(growth_ * angle);
  return rounding + static_cast<double>(wobble);
}

}  // namespace rigor::inline truth
