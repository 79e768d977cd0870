#include "core/dynamics/model/contact_scales.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace rigor::inline dynamics {
namespace {

// m: the radius of gyration about the axis of the largest moment.
double gyration_radius(const Body& body) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(body.inertia, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2]) / body.mass);
}

double length_of(const Scene& scene) {
  double length = 0;
  for (const Body& body : scene.bodies) {
    if (body.collides && !body.fixed) length = std::max(length, bounding_radius(*body.shape));
  }
  if (length > 0) return length;
  for (const Body& body : scene.bodies) {
    if (!body.fixed) length = std::max(length, gyration_radius(body));
  }
  return length > 0 ? length : 1;
}

// Collects rates [1/s], of which the fastest counts. `L` is the scene's length.
class FastestRate {
 public:
  FastestRate(const Scene& scene, double L) : scene_(scene), L_(L) {}

  double find() {
    take(std::sqrt(scene_.gravity.norm() / L_));
    for (const Body& body : scene_.bodies) {
      if (body.fixed) continue;
      take(body.velocity.norm() / L_), take(body.angular_velocity.norm());
    }
    for (const Spring& spring : scene_.springs) {
      const double stiffness = stiffness_at(spring, scene_.extension_at_start(spring));
      for (const int body : {spring.a, spring.b}) take(std::sqrt(stiffness * per_mass(body)));
    }
    for (const TimedForce& force : scene_.forces) {
      const double moment = force.torque.norm() + force.point.norm() * force.force.norm();
      take(std::sqrt(force.force.norm() * per_mass(force.body) / L_));
      take(std::sqrt(moment * per_mass(force.body)) / L_);
    }
    for (const Joint& joint : scene_.joints) {
      const double stiffness = stiffness_at(joint, joint.rest);
      for (const int body : {joint.a, joint.b}) take(std::sqrt(stiffness * per_mass(body)) / arm_of(joint));
    }
    for (const Motor& motor : scene_.motors) take_motor(motor);
    return fastest_;
  }

 private:
  void take(double rate) {
    if (std::isfinite(rate)) fastest_ = std::max(fastest_, rate);
  }
  double per_mass(int body) const {
    return body == kWorld || scene_.bodies[body].fixed ? 0 : 1 / scene_.bodies[body].mass;
  }
  // Turns an effort into a force, and a rate into a speed.
  double arm_of(const Joint& joint) const { return turns(joint) ? L_ : 1; }
  void take_motor(const Motor& motor) {
    take_drive(motor, motor.joint, 1);
    for (const JointTerm& term : motor.plus) take_drive(motor, term.joint, std::abs(term.ratio));
  }
  // On a joint's coordinate, which counts `ratio` times in what the motor drives.
  void take_drive(const Motor& motor, int k, double ratio) {
    const Joint& joint = scene_.joints[k];
    const double arm = arm_of(joint);
    take(std::abs(motor.speed.value_or(0)) * arm / L_);
    const double servo = motor.servo && std::isfinite(motor.servo->most) ? motor.servo->most : 0;
    double effort = std::max({std::abs(motor.effort), motor.most, servo});
    for (const double value : motor.efforts ? motor.efforts->values : std::vector<double>())
      effort = std::max(effort, std::abs(value));
    for (const int body : {joint.a, joint.b}) {
      take(std::sqrt(effort * per_mass(body) / (arm * L_)));
      if (motor.servo) take(ratio * std::sqrt(motor.servo->kp * per_mass(body)) / arm);
    }
  }

  const Scene& scene_;
  double L_;
  double fastest_ = 0;
};

}  // namespace

ContactScales contact_scales(const Scene& scene, double factor) {
  const double length = length_of(scene), rate = FastestRate(scene, length).find();
  return {length, rate > 0 ? 1 / rate : 1, factor};
}

}  // namespace rigor::inline dynamics
