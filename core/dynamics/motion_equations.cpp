#include "core/dynamics/motion_equations.h"

#include <utility>

namespace rigor {
namespace {

constexpr Eigen::Index kVelocityAt = 3, kMomentumAt = 6, kOrientationAt = 9;

Vec3 rotation_vector_rate(const Vec3& phi, const Vec3& w) {
  const Vec3 turn = phi.cross(w);
  return w - 0.5 * turn + phi.cross(turn) / 12;
}

Eigen::Vector4d quaternion_rate(const Quat& q, const Vec3& w) {
  return (Quat(0, 0.5 * w.x(), 0.5 * w.y(), 0.5 * w.z()) * q).coeffs();
}

}  // namespace

MotionEquations::MotionEquations(const System& system, OrientationChart chart)
    : system_(system),
      chart_(chart),
      width_(kOrientationAt + (chart == OrientationChart::quaternion ? 4 : 3)),
      start_(system.size()) {}

void MotionEquations::begin(BodyColumns state, Eigen::VectorXd& y) {
  stage_ = state;
  y.resize(dimension());
  for (std::size_t i = 0; i < state.size(); ++i) {
    start_[i] = state.orientation(i);
    y.segment<3>(at(i)) = state.position(i);
    y.segment<3>(at(i) + kVelocityAt) = state.velocity(i);
    y.segment<3>(at(i) + kMomentumAt) =
        angular_momentum_of(system_.bodies[i], state.rotation(i), state.angular_velocity(i));
    if (chart_ == OrientationChart::quaternion)
      y.segment<4>(at(i) + kOrientationAt) = start_[i].coeffs();
    else
      y.segment<3>(at(i) + kOrientationAt).setZero();
  }
}

void MotionEquations::rates(const Vector& y, double t, double dt, Eigen::Ref<Eigen::VectorXd> out) {
  write(y, stage_.columns());
  const BodyColumns stage = std::as_const(stage_).columns();
  system_.wrenches(stage, t, dt, wrenches_);
  for (std::size_t i = 0; i < stage.size(); ++i) {
    if (system_.bodies[i].fixed) {
      out.segment(at(i), width_).setZero();
      continue;
    }
    const Vec3 w = stage.angular_velocity(i);
    out.segment<3>(at(i)) = stage.velocity(i);
    out.segment<3>(at(i) + kVelocityAt) = system_.bodies[i].inverse_mass * wrenches_[i].force;
    out.segment<3>(at(i) + kMomentumAt) = wrenches_[i].torque;
    if (chart_ == OrientationChart::quaternion)
      out.segment<4>(at(i) + kOrientationAt) = quaternion_rate(stage.orientation(i), w);
    else
      out.segment<3>(at(i) + kOrientationAt) = rotation_vector_rate(y.segment<3>(at(i) + kOrientationAt), w);
  }
}

void MotionEquations::write(const Vector& y, MutableBodyColumns state) const {
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (system_.bodies[i].fixed) continue;
    const Quat q = orientation_of(y, i);
    state.set_position(i, y.segment<3>(at(i)));
    state.set_velocity(i, y.segment<3>(at(i) + kVelocityAt));
    state.set_orientation(i, q);
    state.set_angular_velocity(i,
                               angular_velocity_of(system_.bodies[i], matrix_of(q), y.segment<3>(at(i) + kMomentumAt)));
  }
}

Quat MotionEquations::orientation_of(const Vector& y, std::size_t body) const {
  if (chart_ == OrientationChart::quaternion) {
    return Quat(Eigen::Vector4d(y.segment<4>(at(body) + kOrientationAt))).normalized();
  }
  return (rotation_by(y.segment<3>(at(body) + kOrientationAt)) * start_[body]).normalized();
}

double MotionEquations::relative_size(const Vector& change, const Vector& y) const {
  double largest = 0;
  for (std::size_t i = 0; i < system_.size(); ++i) {
    if (system_.bodies[i].fixed) continue;
    const Mat3 R = matrix_of(orientation_of(y, i));
    const auto spin = [&](const Vector& v) {
      return angular_velocity_of(system_.bodies[i], R, v.segment<3>(at(i) + kMomentumAt)).norm();
    };
    const auto part = [&](Eigen::Index where) {
      return change.segment<3>(at(i) + where).norm() / (1 + y.segment<3>(at(i) + where).norm());
    };
    const double angle = 2 * change.segment<4>(at(i) + kOrientationAt).norm();
    // A value that is not a number must not be lost in a comparison.
    const double body = part(0) + part(kVelocityAt) + spin(change) / (1 + spin(y)) + angle;
    if (!(body <= largest)) largest = body;
  }
  return largest;
}

}  // namespace rigor
