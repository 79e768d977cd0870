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

#include "cases/truth/solved/axis_drive.h"
#include "cases/truth/solved/axis_modes.h"
#include "core/scene/scene.h"

namespace rigor::inline truth {

template <typename Real>
struct JointAxis {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  using Matrix = Eigen::Matrix<Real, 3, 3>;

  std::size_t joint = 0;
  bool is_hinge = true;
  Vector direction_a;  // in a's frame
  Matrix turn_start;   // R_a^T R_b at t = 0
  Real way_start = 0;  // m

  JointAxis(const Scene& scene, std::size_t index)
      : JointAxis(scene, index, *free_axis(scene.joints[index]), turns(scene.joints[index])) {}

  // Of the turn about an axis, or the way along it, that the joint allows.
  JointAxis(const Scene& scene, std::size_t index, const Vec3& axis, bool turns) : joint(index), is_hinge(turns) {
    const Joint& row = scene.joints[index];
    const auto rotation = [&](int body) {
      if (body == kWorld) return Matrix(Matrix::Identity());
      return Matrix(scene.bodies[body].orientation.template cast<Real>().normalized().toRotationMatrix());
    };
    const auto position = [&](int body) {
      return body == kWorld ? Vector(Vector::Zero()) : Vector(scene.bodies[body].position.template cast<Real>());
    };
    direction_a = rotation(row.a).transpose() * axis.template cast<Real>().normalized();
    turn_start = rotation(row.a).transpose() * rotation(row.b);
    way_start = direction_a.dot(rotation(row.a).transpose() * (position(row.b) - position(row.a)));
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

// A servo on a sum of coordinates.
template <typename Real>
struct SumServo {
  struct Term {
    std::size_t axis;
    Real ratio;
  };
  std::vector<Term> terms;
  ServoLaw<Real> law;
};

// A joint's coordinate [rad, m] and its rate.
template <typename Real>
struct AxisValue {
  Real x, rate;
};

// The timed forces, and the joints' efforts, that act at one instant.
template <typename Real>
struct ActingLoads {
  std::vector<const TimedForce*> forces;
  std::vector<AxisDrive<Real>> drives;  // of each axis
  std::vector<SumServo<Real>> sums;

  ActingLoads(const Scene& scene, const std::vector<JointAxis<Real>>& axes, double t, const AxisModes& modes) {
    for (const TimedForce& force : scene.forces) {
      if (t >= force.from && t < force.until) forces.push_back(&force);
    }
    for (std::size_t k = 0; k < axes.size(); ++k)
      drives.emplace_back(scene, axes[k].joint, t, modes.empty() ? AxisMode() : modes[k]);
    for (const Motor& motor : scene.motors) {
      if (motor.plus.empty() || !(t >= motor.from && t < motor.until)) continue;
      SumServo<Real>& sum = sums.emplace_back(SumServo<Real>{{}, ServoLaw<Real>(*motor.servo, false, t)});
      const auto add = [&](int joint, double ratio) {
        const auto is_its = [&](const JointAxis<Real>& axis) { return axis.joint == static_cast<std::size_t>(joint); };
        const auto axis = std::find_if(axes.begin(), axes.end(), is_its);
        sum.terms.push_back({static_cast<std::size_t>(axis - axes.begin()), static_cast<Real>(ratio)});
      };
      add(motor.joint, 1);
      for (const JointTerm& term : motor.plus) add(term.joint, term.ratio);
    }
  }

  // By axis: what the servos on sums add to its effort. `value_of(k)` is an AxisValue; `clock` as in AxisDrive.
  template <typename ValueOf>
  std::vector<Real> efforts_of_sums(const Real* clock, const ValueOf& value_of) const {
    std::vector<Real> efforts(drives.size(), Real(0));
    for (const SumServo<Real>& sum : sums) {
      AxisValue<Real> of_sum = {0, 0};
      for (const auto& [axis, ratio] : sum.terms) {
        const AxisValue<Real> at = value_of(axis);
        of_sum.x += ratio * at.x, of_sum.rate += ratio * at.rate;
      }
      const Real effort = sum.law.effort(of_sum.x, of_sum.rate, clock[0]);
      for (const auto& [axis, ratio] : sum.terms) efforts[axis] += ratio * effort;
    }
    return efforts;
  }
};

// The axes of joints with a spring, damper, motor, armature, coupling or limit.
template <typename Real>
std::vector<JointAxis<Real>> axes_in_use(const Scene& scene) {
  std::vector<JointAxis<Real>> axes;
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    const Joint& joint = scene.joints[k];
    const bool is_driven = std::any_of(scene.motors.begin(), scene.motors.end(),
                                       [k](const Motor& motor) { return motor.drives(static_cast<int>(k)); });
    const bool is_coupled = std::any_of(scene.couplings.begin(), scene.couplings.end(),
                                        [k](const Coupling& coupling) { return coupling.joins(static_cast<int>(k)); });
    if (joint.stiffness != 0 || joint.damping != 0 || joint.armature != 0 || joint.has_limits() || is_driven ||
        is_coupled)
      axes.emplace_back(scene, k);
  }
  return axes;
}

}  // namespace rigor::inline truth
