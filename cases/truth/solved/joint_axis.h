// The coordinate of a hinge or slider, for any number type: the angle [rad] by which b has turned against a about the
// axis since t = 0, from -pi to pi, or the way [m] that b's centre has come along it.
#pragma once

#include <cmath>
#include <vector>

#include "core/scene/scene.h"

namespace rigor {

template <typename Real>
struct JointAxis {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  using Matrix = Eigen::Matrix<Real, 3, 3>;

  std::size_t joint = 0;
  bool is_hinge = true;
  Vector direction_a;  // in a's frame
  Matrix turn_start;   // R_a^T R_b at t = 0
  Real way_start = 0;  // m

  JointAxis(const Scene& scene, std::size_t index) : joint(index) {
    const Joint& row = scene.joints[index];
    is_hinge = std::holds_alternative<HingeJoint>(row.type);
    const Vec3& axis = is_hinge ? std::get<HingeJoint>(row.type).axis : std::get<SliderJoint>(row.type).axis;
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

  Real coordinate(const Vector& p_a, const Matrix& R_a, const Vector& p_b, const Matrix& R_b) const {
    using std::atan2;
    if (!is_hinge) return direction_a.dot(R_a.transpose() * (p_b - p_a)) - way_start;
    const Matrix turn = R_a.transpose() * R_b * turn_start.transpose();
    const Vector twice_sine(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
    return atan2(direction_a.dot(twice_sine), turn.trace() - 1);
  }
};

// The timed forces, and the joints' efforts, that act at one instant.
template <typename Real>
struct ActingLoads {
  std::vector<const TimedForce*> forces;
  std::vector<std::pair<std::size_t, Real>> efforts;  // index in `axes`, and what motors give [N m or N]

  ActingLoads(const Scene& scene, const std::vector<JointAxis<Real>>& axes, double t) {
    for (const TimedForce& force : scene.forces) {
      if (t >= force.from && t < force.until) forces.push_back(&force);
    }
    for (std::size_t k = 0; k < axes.size(); ++k) {
      Real driven = 0;
      for (const Motor& motor : scene.motors) {
        const bool acts = t >= motor.from && t < motor.until;
        if (acts && static_cast<std::size_t>(motor.joint) == axes[k].joint) driven += static_cast<Real>(motor.effort);
      }
      efforts.emplace_back(k, driven);
    }
  }
};

// Of the joints that a spring, damper or motor acts along.
template <typename Real>
std::vector<JointAxis<Real>> axes_with_effort(const Scene& scene) {
  std::vector<JointAxis<Real>> axes;
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    bool has_effort = scene.joints[k].stiffness != 0 || scene.joints[k].damping != 0;
    for (const Motor& motor : scene.motors) has_effort |= static_cast<std::size_t>(motor.joint) == k;
    if (has_effort) axes.emplace_back(scene, k);
  }
  return axes;
}

}  // namespace rigor
