#include "core/dynamics/contact/cone_newton.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace rigor {
namespace {

constexpr int kMostSteps = 30;
constexpr double kLittle = 1e-9;  // of a point's own inverse mass

}  // namespace

// Fills residual_ [m/s] and derivative_ at p_ and u_; returns the largest residual.
double ConeNewton::assemble(const Eigen::MatrixXd& coupling, const std::vector<ConePoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    const ConePoint& point = points[i];
    const double give = point.inverse_mass(0, 0), over = u_[at] - point.wanted;
    if (give * p_[at] - over <= 0) {  // open
      residual_.segment<3>(at) = give * p_.segment<3>(at);
      derivative_.middleRows<3>(at).setZero();
      derivative_.block<3, 3>(at, at) = give * Mat3::Identity();
      continue;
    }
    residual_[at] = over;
    derivative_.row(at) = coupling.row(at);
    derivative_(at, at) += kLittle * give;
    assemble_friction(coupling, point, at);
  }
  return residual_.cwiseAbs().maxCoeff();
}

void ConeNewton::assemble_friction(const Eigen::MatrixXd& coupling, const ConePoint& point, Eigen::Index at) {
  const double scale = 1 / point.tangent_pace;
  const Eigen::Vector2d u_t = u_.segment<2>(at + 1), p_t = p_.segment<2>(at + 1), z = p_t - point.tangent_pace * u_t;
  const double radius = std::isinf(point.friction) ? point.friction : point.friction * std::max(0.0, p_[at]);
  const double size = z.norm();
  if (size <= radius) {  // sticking
    residual_.segment<2>(at + 1) = u_t;
    derivative_.middleRows<2>(at + 1) = coupling.middleRows<2>(at + 1);
    derivative_(at + 1, at + 1) += kLittle * scale;
    derivative_(at + 2, at + 2) += kLittle * scale;
    return;
  }
  const Eigen::Vector2d d = z / size;
  const Eigen::Matrix2d across = radius / size * (Eigen::Matrix2d::Identity() - d * d.transpose());
  residual_.segment<2>(at + 1) = scale * (p_t - radius * d);
  derivative_.middleRows<2>(at + 1) = across * coupling.middleRows<2>(at + 1);
  derivative_.block<2, 2>(at + 1, at + 1) += scale * (Eigen::Matrix2d::Identity() - across);
  derivative_.block<2, 1>(at + 1, at) -= scale * point.friction * d;
}

Eigen::VectorXd ConeNewton::solve(const Eigen::MatrixXd& coupling, const Eigen::VectorXd& velocities,
                                  const std::vector<ConePoint>& points, double tolerance) {
  const Eigen::Index n = coupling.rows();
  p_.resize(n), residual_.resize(n), derivative_.resize(n, n);
  for (std::size_t i = 0; i < points.size(); ++i) p_.segment<3>(static_cast<Eigen::Index>(3 * i)) = points[i].impulse;
  u_ = velocities;
  const Eigen::VectorXd start = p_;
  Eigen::VectorXd best = p_;
  double least = assemble(coupling, points);
  for (int k = 0; k < kMostSteps && least > tolerance; ++k) {
    const Eigen::VectorXd change = derivative_.partialPivLu().solve(-residual_);
    if (!change.allFinite()) break;
    p_ += change;
    u_ += coupling * change;
    const double now = assemble(coupling, points);
    if (now < least) least = now, best = p_;
  }
  return best - start;
}

}  // namespace rigor
