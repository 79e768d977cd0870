// The coordinate of a hinge or slider, for any number type. For a hinge it is the angle [rad] of b relative to a about
// the axis since t = 0, including whole turns. For a slider it is the displacement [m] of b's centre along the axis.
// Poses do not determine the number of whole turns. The motion therefore integrates the angle's rate, and this code
// rounds the angle to the nearest turn.
#pragma once

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline truth {

template <typename Real>
struct JointAxis {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  using Matrix = Eigen::Matrix<Real, 3, 3>;

  std::size_t joint = 0;
  int a = kWorld, b = kWorld;  // its ends
  bool is_hinge = true;
  bool is_in_series = false;  // of a compound joint, whose rows know its coordinate (series_rows.h)
  Vector direction_a;         // in a's frame
  Matrix turn_start;          // R_a^T R_b at t = 0
  Real way_start = 0;         // m

  JointAxis(const Scene& scene, std::size_t index)
      : JointAxis(scene, index, *free_axis(scene.joints[index]), turns(scene.joints[index])) {
    is_in_series = std::holds_alternative<CompoundAxis>(scene.joints[index].type);
  }

  // Of the turn about an axis, or the way along it, that the joint allows.
  JointAxis(const Scene& scene, std::size_t index, const Vec3& axis, bool turns)
      : joint(index), a(scene.joints[index].a), b(scene.joints[index].b), is_hinge(turns) {
    const auto rotation = [&](int body) {
      if (body == kWorld) return Matrix(Matrix::Identity());
      return Matrix(scene.bodies[body].orientation.template cast<Real>().normalized().toRotationMatrix());
    };
    const auto position = [&](int body) {
      return body == kWorld ? Vector(Vector::Zero()) : Vector(scene.bodies[body].position.template cast<Real>());
    };
    direction_a = rotation(a).transpose() * axis.template cast<Real>().normalized();
    turn_start = rotation(a).transpose() * rotation(b);
    way_start = direction_a.dot(rotation(a).transpose() * (position(b) - position(a)));
  }

  // `turned`: the angle, to within half a turn.
  Real coordinate(const Vector& p_a, const Matrix& R_a, const Vector& p_b, const Matrix& R_b, Real turned) const {
    using std::atan2;
    using std::round;
    if (!is_hinge) return direction_a.dot(R_a.transpose() * (p_b - p_a)) - way_start;
    const Matrix turn = R_a.transpose() * R_b * turn_start.transpose();
    const Vector twice_sine(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
    const Real angle = atan2(direction_a.dot(twice_sine), turn.trace() - 1),
               whole = 2 * boost::math::constants::pi<Real>();
    return angle + whole * round((turned - angle) / whole);
  }
};

// The place of a joint's axis among those in use.
template <typename Real>
std::size_t place_of(int joint, const std::vector<JointAxis<Real>>& axes) {
  const auto is_its = [&](const JointAxis<Real>& axis) { return axis.joint == static_cast<std::size_t>(joint); };
  return static_cast<std::size_t>(std::find_if(axes.begin(), axes.end(), is_its) - axes.begin());
}

// The axes of joints with a spring, damper, motor, armature, coupling or limit; and all axes of compound joints, whose
// poses alone do not say which of several solutions their angles are.
template <typename Real>
std::vector<JointAxis<Real>> axes_in_use(const Scene& scene) {
  std::vector<JointAxis<Real>> axes;
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    const Joint& joint = scene.joints[k];
    const bool is_driven = std::any_of(scene.motors.begin(), scene.motors.end(),
                                       [k](const Motor& motor) { return motor.drives(static_cast<int>(k)); });
    const bool is_coupled = std::any_of(scene.couplings.begin(), scene.couplings.end(),
                                        [k](const Coupling& coupling) { return coupling.joins(static_cast<int>(k)); });
    const bool is_in_series = std::holds_alternative<CompoundAxis>(joint.type);
    if (is_in_series || joint.stiffness != 0 || joint.damping != 0 || joint.armature != 0 || joint.has_limits() ||
        is_driven || is_coupled)
      axes.emplace_back(scene, k);
  }
  return axes;
}

}  // namespace rigor::inline truth
